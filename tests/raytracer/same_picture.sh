#!/bin/sh
# SPDX-License-Identifier: MIT
# One picture, byte for byte, whatever the partition, bundle, selection and number of ranks; and counts that do not depend
# on them either.
# usage: same_picture.sh RAYTRACER MPIEXEC
. "$(dirname "$(realpath "$0")")/begin.sh"
scene="--scene teapot --scene-size 3 --resolution 48x40"

"$raytracer" $scene --output serial.png --cost-map serial.csv --stats serial.json > serial.txt
grep -q 'rays through 561 objects' serial.txt

# usage: check RANKS OPTIONS...
check() {
  ranks=$1
  shift
  "$mpiexec" --oversubscribe -n "$ranks" "$raytracer" $scene "$@" --output other.png --cost-map other.csv \
    --stats other.json > other.txt
  cmp serial.png other.png || { echo "picture differs: $ranks ranks, $*"; exit 1; }
  cmp serial.csv other.csv || { echo "cost map differs: $ranks ranks, $*"; exit 1; }
  for key in eye_rays shadow_rays shadow_hits reflected_rays box_tests primitive_tests; do
    test "$(grep "\"$key\"" serial.json)" = "$(grep "\"$key\"" other.json)" \
      || { echo "$key differs: $ranks ranks, $*"; exit 1; }
  done
  grep -q "\"ranks\": $ranks," other.json
  rm other.png other.csv other.json
}

check 1 --partition bundles --select random
check 2 --partition tiled --tile columns
check 3 --partition tiled --tile blocks
check 5 --partition scattered
check 2 --partition bundles --bundle 1000
check 3 --partition bundles --bundle 49 --select modulo
check 5 --partition bundles --bundle 7 --select random --seed 3
check 5 --partition bundles --bundle 100000
check 1 --partition guided
check 2 --partition guided
check 5 --partition guided

# Adaptive sampling decides from the whole picture, so that it too depends on no partition.
scene="--scene balls --scene-size 2 --resolution 24x20 --samples adaptive --tolerance 0.003"
"$raytracer" $scene --output serial.png --cost-map serial.csv --stats serial.json > serial.txt
eye_rays=$(sed -n 's/.*"eye_rays": \([0-9]*\).*/\1/p' serial.json)
test "$eye_rays" -gt $((24 * 20 * 9)) -a "$eye_rays" -lt $((24 * 20 * 200)) || { echo "adaptive: $eye_rays rays"; exit 1; }
check 3 --partition tiled --tile blocks
check 4 --partition scattered
check 3 --partition bundles --bundle 50
check 4 --partition bundles --bundle 7 --select random
check 3 --partition guided

"$raytracer" --compare serial.png serial.png | grep -q '^identical'
"$raytracer" $scene --max-depth 1 --output shallow.png > shallow.txt
grep -q 'could have added at most' shallow.txt
if "$raytracer" --compare serial.png shallow.png --output where.png > compare.txt; then echo "a difference went unseen"; exit 1; fi
grep -q '^different: .* dB' compare.txt
test -s where.png
echo "same picture everywhere"
