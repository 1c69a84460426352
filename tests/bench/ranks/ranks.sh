# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run. Two ranks that help themselves to bundles (--partition guided) against two runs of one rank
# side by side, each on a core of its own: the same work without anything to share.

# usage: alone FILE CORE ARGUMENT...: rendering's statistics
alone() { taskset -c "$2" "$build/bin/raytracer-bare" "${@:3}" --stats "$1" > "$1.txt" 2>&1; }

run_ranks() {
  (($(nproc) >= 2)) || { echo "needs two cores"; return; }
  local scene i
  echo "Throughput of rendering 1024x1024 on 2 ranks over that of two runs of one rank side by side; the CPU time it takes in all over theirs."
  for scene in "teapot --scene-size 12" "rings --scene-size 7"; do
    local words="--scene $scene --resolution 1024x1024 --samples 1 --partition guided"
    for ((i = 0; i < rounds; ++i)); do
      alone "$work/a.json" 0 $words & alone "$work/b.json" 1 $words
      wait
      mpirun --oversubscribe -n 2 "$build/bin/raytracer-bare" $words --stats "$work/both.json" > "$work/both.txt" 2>&1 || return 1
      awk -v a="$(json_figure "$work/a.json" render_s)" -v b="$(json_figure "$work/b.json" render_s)" \
        -v both="$(json_figure "$work/both.json" render_s)" -v a_cpu="$(json_figure "$work/a.json" render_cpu_s)" \
        -v b_cpu="$(json_figure "$work/b.json" render_cpu_s)" -v both_cpu="$(json_figure "$work/both.json" render_cpu_s)" \
        'BEGIN { print 1 / both / (1 / a + 1 / b), both_cpu / ((a_cpu + b_cpu) / 4), a, b, both }'
    done > "$work/ranks"
    awk '{ printf "    alone %.3f s and %.3f s, together %.3f s\n", $3, $4, $5 }' "$work/ranks"
    verdict "$(sort -n "$work/ranks" | awk '{ r[NR] = $1 } END { print r[int((NR + 1) / 2)] }')" 0.97 "$scene, throughput" at-least
    verdict "$(sort -n -k2 "$work/ranks" | awk '{ r[NR] = $2 } END { print r[int((NR + 1) / 2)] }')" 1.02 "$scene, CPU time of the slower rank, doubled"
  done
}
