#!/bin/sh
# SPDX-License-Identifier: MIT
# Objects divided among ranks give the serial program's picture, byte for byte, and its rays, whatever the partition of the
# rays, the size of packages and the number of ranks; and a scene that fits on no rank is refused with numbers.
# usage: divided.sh RAYTRACER MPIEXEC
. "$(dirname "$(realpath "$0")")/begin.sh"

# usage: serial OPTIONS...
serial() {
  scene="$*"
  "$raytracer" $scene --output serial.png --stats serial.json > serial.txt
}

# usage: check RANKS OPTIONS...
check() {
  ranks=$1
  shift
  timeout 100 "$mpiexec" --oversubscribe -n "$ranks" "$raytracer" $scene "$@" --output other.png --stats other.json > other.txt
  cmp serial.png other.png || { echo "picture differs: $scene: $ranks ranks, $*"; exit 1; }
  for key in objects eye_rays eye_hits shadow_rays shadow_hits reflected_rays refracted_rays; do
    test "$(grep "\"$key\"" serial.json)" = "$(grep "\"$key\"" other.json)" \
      || { echo "$key differs: $scene: $ranks ranks, $*"; exit 1; }
  done
  grep -q '"copies": ' other.json || { echo "not divided: $scene: $ranks ranks, $*"; exit 1; }
  rm other.png other.json
}

divided="--objects partitioned"
serial --scene teapot --scene-size 3 --resolution 48x40
check 1 $divided
check 2 $divided --package 1
check 3 $divided --partition tiled --replicate 0.7
check 5 $divided --partition bundles --bundle 100 --package 7
check 5 $divided --partition guided --replicate 1
check 5 --objects coupled --partition bundles --bundle 100
check 4 --objects coupled --replicate 0.8 --partition guided
check 3 --objects coupled --replicate 1 --partition scattered
grep -q 'the pilot foretold .* journeys per ray' other.txt
serial --scene rings --scene-size 2 --resolution 40x40 --samples 2 --precision float
check 4 $divided --partition bundles --bundle 64 --select modulo
serial --scene tree --scene-size 4 --resolution 40x40 --kernel embree
check 3 $divided

# Water in a glass, a light that rays meet: what a ray is inside of travels with it.
cat > glass.nff <<'NFF'
v from 0 -6 2 at 0 0 0 up 0 0 1 angle 45 hither 0.1 resolution 40 40
b 0.1 0.2 0.4
l 3 -4 5 1 1 1 0.5
l -4 -3 6 0.8 0.8 1 0
f 0.9 0.9 0.9 0.1 0.1 20 0.8 1.5 2
s 0 0 0 1.2
f 0.3 0.5 0.9 0.1 0 10 0.9 1.33 1
s 0.3 0 0.2 1.0
f 0.8 0.7 0.6 0.9 0.1 10 0 1
p 4 -6 -6 -1.3 6 -6 -1.3 6 6 -1.3 -6 6 -1.3
s 1.5 1 -0.6 0.7
s -1.6 0.5 -0.6 0.7
NFF
serial --scene glass.nff --max-depth 8
check 4 $divided --package 3
check 3 $divided --replicate 0.6

# One object in all parts, all in one place, none at all.
printf 'v from 0 -6 2 at 0 0 0 up 0 0 1 angle 45 hither 0.1 resolution 16 16\nb 0 0.2 0.4\nl 3 -4 5\ns 0 0 0 900\n' > enormous.nff
{ sed 's/900/1/' enormous.nff; for i in 1 2 3 4 5 6 7; do echo 's 0 0 0 1'; done; } > heap.nff
grep -v '^s' enormous.nff > none.nff
for scene in enormous heap none; do
  serial --scene $scene.nff
  check 5 $divided --partition tiled
  check 3 $divided --partition bundles --bundle 16 --package 1
  check 3 $divided --partition guided
  check 4 --objects coupled --partition bundles --bundle 16
  check 3 --objects coupled --partition guided
done

# A limit that the scene does not fit into divides it; one that not even a part fits into is refused.
serial --scene balls --scene-size 3 --resolution 40x40
check 4 --memory-limit 120K
if timeout 100 "$mpiexec" --oversubscribe -n 4 "$raytracer" $scene --memory-limit 20K > no.txt 2>&1; then echo "20 kB were enough"; exit 1; fi
grep -q 'divided among 4 ranks, 1 leaf each, the objects of one take up to 0\.[0-9]* MB .* 0.0 MB are allowed' no.txt || { cat no.txt; exit 1; }
if "$raytracer" $scene --objects coupled --samples adaptive > no.txt 2>&1; then echo "adaptive was not refused"; exit 1; fi
grep -q -- '--samples N' no.txt
echo "same picture, divided"
