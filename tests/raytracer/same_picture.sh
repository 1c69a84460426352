#!/bin/sh
# SPDX-License-Identifier: MIT
# One picture, byte for byte, whatever the partition, bundle, selection and number of ranks; and counts that do not depend
# on them either.
# usage: same_picture.sh RAYTRACER MPIEXEC
set -eu
raytracer=$1
mpiexec=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$(dirname "$(realpath "$0")")/../mpi_environment.sh"
cd "$work"
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

"$raytracer" --compare serial.png serial.png | grep -q '^identical'
"$raytracer" $scene --max-depth 1 --output shallow.png > shallow.txt
if "$raytracer" --compare serial.png shallow.png > compare.txt; then echo "a difference went unseen"; exit 1; fi
grep -q '^different' compare.txt
echo "same picture everywhere"
