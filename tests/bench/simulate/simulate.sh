# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run. What simulating costs, that it is the same every time, and how far the prices of the modern
# machine are from this one.

# usage: simulated FILE OPTIONS... -- raytracer ARGUMENTS: JSON in FILE, CPU seconds in FILE.cpu
simulated() {
  local file=$1
  shift
  local TIMEFORMAT='%U %S'
  { time "$build/bin/stipple" simulate "$@" > "$file" 2> "$file.err"; } 2> "$file.time"
  awk '{ print $1 + $2 }' "$file.time" > "$file.cpu"
}

json_figure() { sed -nE "s/.*\"$2\": ?\"?([^,\"}]*).*/\1/p" "$1"; }

run_simulate() {
  [ -f "$build/lib/stipple/simulate/raytracer.so" ] || { echo "stipple simulate is not built: no SimGrid"; return; }
  local teapot="raytracer --scene teapot --scene-size 8 --resolution 512x512 --samples 1 --partition bundles" i scene
  echo "CPU seconds of a simulated run, with the archive, its compaction and its reading."
  for ((i = 0; i < 10; ++i)); do
    simulated "$work/small.$i" --machine ipsc2 --nodes 32 -o "$work/s.stipple" --overwrite --json -- $teapot --bundle 512
  done
  verdict "$(sort -n "$work"/small.*.cpu | sed -n 5p)" 10 "33 ranks, 512x512, CPU s"
  simulated "$work/large" --machine modern --nodes 1024 -o "$work/s.stipple" --overwrite --json -- $teapot --bundle 64
  verdict "$(cat "$work/large.cpu")" 60 "1025 ranks, 512x512, CPU s"
  verdict "$(cat "$work"/small.? | grep -c "$(json_figure "$work/small.0" hash)")" 10 "runs of 10 with the same hash" at-least
  echo "Simulated seconds of one modern node over CPU seconds of this machine's core."
  for scene in balls "rings --scene-size 5" "teapot --scene-size 8" "tree --scene-size 10"; do
    local words="--scene $scene --resolution 384x384 --samples 1"
    for i in 1 2 3; do
      "$build/bin/raytracer-bare" $words --stats "$work/real.json" > "$work/real.txt"
      json_figure "$work/real.json" render_cpu_s
    done | sort -n > "$work/real.s"
    simulated "$work/one" --machine modern --nodes 1 -o "$work/s.stipple" --overwrite --json -- raytracer $words
    awk -v scene="$scene" -v simulated="$(json_figure "$work/one" simulated_s)" -v real="$(head -1 "$work/real.s")" \
      'BEGIN { printf "  %-22s %.3f s / %.3f s = %.2f\n", scene, simulated, real, simulated / real }'
  done
}
