#!/bin/sh
# SPDX-License-Identifier: MIT
# Unusable input ends with exit status 2 and one message, however many ranks saw it.
# usage: refuses_bad_input.sh RAYTRACER MPIEXEC
. "$(dirname "$(realpath "$0")")/begin.sh"
printf 'v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 resolution 8 8\ns 0 0 0 1\ns 1 1 1 0\n' > bad.nff

# usage: refuse EXPECTED-MESSAGE COMMAND...
refuse() {
  message=$1
  shift
  status=0
  "$@" > out.txt 2> err.txt || status=$?
  test "$status" = 2 || { echo "status $status: $*"; cat err.txt; exit 1; }
  grep -qF -e "$message" err.txt || { echo "expected '$message': $*"; cat err.txt; exit 1; }
  test "$(grep -c '^raytracer: ' err.txt)" = 1 || { echo "not one message: $*"; cat err.txt; exit 1; }
}

refuse 'bad.nff:3: sphere of radius 0' "$raytracer" --scene bad.nff
refuse 'bad.nff:3: sphere of radius 0' "$mpiexec" --oversubscribe -n 3 "$raytracer" --scene bad.nff
refuse 'none.nff: cannot be read' "$raytracer" --scene none.nff
refuse 'none/x.png: cannot be written' "$mpiexec" --oversubscribe -n 2 "$raytracer" --scene-size 0 --resolution 4x4 \
  --partition bundles --output none/x.png
refuse '--fast: unknown option; known are --scene' "$raytracer" --fast
refuse '--tile circles: unknown; known are rows, columns, blocks' "$raytracer" --tile circles
refuse 'rings have above' "$raytracer" --scene balls --camera above
refuse 'coordinates and distances reach' "$raytracer" --precision float
refuse 'the scene does not fit: 7382 objects' "$raytracer" --memory-limit 100K
refuse '--memory-limit 1X: should be BYTES' "$raytracer" --memory-limit 1X
refuse 'none.png: cannot be read' "$raytracer" --compare none.png none.png
refuse 'Embree does not count its tests' "$raytracer" --kernel embree --cost-map x.png
echo "all refused"
