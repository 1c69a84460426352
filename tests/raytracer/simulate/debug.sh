#!/bin/sh
# SPDX-License-Identifier: MIT
# A ray tracer that was hardly optimised and checks itself has the hash of the usual one.
# usage: debug.sh STIPPLE CMAKE BUILD_DIR
set -eu
stipple=$1
cmake=$2
build=$3
debug=$build/raytracer/simulate/debug
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$cmake" --build "$build" --target raytracer_simulated_debug > "$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
# stipple finds the ray tracer by where it is itself.
mkdir -p "$debug/bin"
cp "$stipple" "$debug/bin/stipple"
ln -sf "$build/lib/stipple/simulate/libstipple-machine.so" "$debug/lib/stipple/simulate/"
cd "$work"
for scene in teapot balls rings; do
  for divided in "--partition bundles" "--partition tiled" "--objects partitioned" "--objects coupled --partition bundles"; do
    for program in "$stipple" "$debug/bin/stipple"; do
      "$program" simulate --machine ipsc2 --nodes 8 -o run.stipple --overwrite --json -- raytracer --scene $scene \
        --scene-size 3 --resolution 48x48 $divided --bundle 64 > run.json 2> run.err || { cat run.err >&2; exit 1; }
      cat run.json
    done | uniq > runs.json
    test "$(wc -l < runs.json)" = 1 || { cat runs.json; echo "FAIL: $scene $divided differs in debug"; exit 1; }
    cat runs.json
  done
done
echo "the same hash in debug and release"
