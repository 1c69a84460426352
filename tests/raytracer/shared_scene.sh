#!/bin/sh
# SPDX-License-Identifier: MIT
# A large scene gives one picture however it came: generated or read, from the cache or not, on one rank or on three that
# share it.
# usage: shared_scene.sh RAYTRACER MPIEXEC
. "$(dirname "$(realpath "$0")")/begin.sh"
export XDG_CACHE_HOME="$work/cache"
generated="--scene rings --scene-size 17" file="--scene rings.nff"
size="--resolution 24x20"

"$raytracer" $generated --write-scene rings.nff > out.txt
"$raytracer" $generated $size --output expected.png > out.txt

# Float is refused where objects are small for their distance; this grid of 10^5 spheres is within its rule.
awk 'BEGIN { print "v from 50 50 160 at 50 50 50 up 0 1 0 angle 45 resolution 8 8\nl 0 0 200\nf 1 1 1 1 0 0 0 0"
  for (x = 0; x < 47; ++x) for (y = 0; y < 47; ++y) for (z = 0; z < 47; ++z) print "s", 2 * x, 2 * y, 2 * z, 0.9 }' > grid.nff
grid="--scene grid.nff --resolution 24x20 --precision float"
XDG_CACHE_HOME=/dev/null "$raytracer" $grid --output float.png > out.txt

# usage: check kept|made EXPECTED.png COMMAND...
check() {
  source=$1 expected=$2
  shift 2
  "$@" --output other.png > out.txt 2> err.txt || { cat out.txt err.txt; exit 1; }
  cmp "$expected" other.png || { echo "picture differs: $*"; exit 1; }
  if grep -q 'scene from ' out.txt; then found=kept; else found=made; fi
  test $found = $source || { echo "scene was $found, not $source: $*"; exit 1; }
  rm other.png
}
three="$mpiexec --oversubscribe -n 3"

check made expected.png $three "$raytracer" $generated $size
check made expected.png "$raytracer" $file $size
check kept expected.png "$raytracer" $file $size
check kept expected.png $three "$raytracer" $file $size
check kept expected.png $three "$raytracer" $file $size --partition bundles --bundle 40
check made float.png $three "$raytracer" $grid
check kept float.png $three "$raytracer" $grid
check made expected.png env XDG_CACHE_HOME=/dev/null $three "$raytracer" $file $size

# The contents count, not the name or the time.
mv rings.nff moved.nff
touch moved.nff
check kept expected.png "$raytracer" --scene moved.nff $size
echo "# another text" >> moved.nff
check made expected.png "$raytracer" --scene moved.nff $size

# Damage is noticed, told once and mended.
for kept in cache/stipple/*.scene; do printf 'xyz' | dd of="$kept" bs=1 seek=100000 conv=notrunc 2> /dev/null; done
check made expected.png $three "$raytracer" --scene moved.nff $size
test "$(grep -c 'damaged; it is made anew' err.txt)" = 1
check kept expected.png $three "$raytracer" --scene moved.nff $size

# Any rank's trouble is everybody's, and is told once.
sed -i 's/^s .*/s 1 2 3 0/' moved.nff
status=0
$three "$raytracer" --scene moved.nff $size > out.txt 2> err.txt || status=$?
test $status = 2
test "$(grep -c '^raytracer: moved.nff:[0-9]*: sphere of radius 0$' err.txt)" = 1
echo "same scene everywhere"
