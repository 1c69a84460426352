# SPDX-License-Identifier: MIT
# Part of tests/bench/run: the ray tracer's own hierarchy against Embree, in the same binary and in turn.

# The scenes that SPD publishes, in its mode: 513 x 513 corner rays, depth 5, nothing cut.
spd_scenes=("balls 4" "rings 7" "teapot 12" "tree 11")

# spd_draw FILE SCENE SIZE OPTION...: draws a scene without instrumentation, statistics into FILE.
spd_draw() {
  "$build/bin/raytracer-bare" --scene "$2" --scene-size "$3" --resolution 512x512 --samples corners --max-depth 5 \
    --min-contribution 0 --stats "$1" "${@:4}" >"$work/out" || { cat "$work/out" >&2; return 1; }
}

# A number of the statistics.
figure() { # FILE KEY
  sed -nE "s/^ *\"$2\": ([0-9.e+-]+),?\$/\1/p" "$1"
}

# Median, least and greatest of a column.
spread() { # FILE COLUMN
  awk -v column="$2" '{ print $column }' "$1" | sort -g |
    awk '{ v[NR] = $1 } END { printf "%.3f %.3f %.3f\n", (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2, v[1], v[NR] }'
}

# Lines "own embree ratio" of CPU seconds, one a round: of rendering, or of building and rendering. The statistics of the
# last round stay in $work/kernel.bvh.json and $work/kernel.embree.json.
kernel_rounds() { # ROUNDS render|both SCENE SIZE
  local round kernel
  for ((round = 0; round < $1; ++round)); do
    for kernel in bvh embree; do
      spd_draw "$work/kernel.$kernel.json" "$3" "$4" --kernel $kernel || return 1
      printf '%s %s ' "$(figure "$work/kernel.$kernel.json" render_cpu_s)" "$(figure "$work/kernel.$kernel.json" build_cpu_s)"
    done
    echo
  done | awk -v what="$2" '{ own = $1 + (what == "both" ? $2 : 0); embree = $3 + (what == "both" ? $4 : 0)
    print own, embree, own / embree }'
}

kernel_line() { # NAME
  local own embree ratio
  own=$(spread "$work/kernel.rounds" 1) embree=$(spread "$work/kernel.rounds" 2) ratio=$(spread "$work/kernel.rounds" 3)
  set -- "$1" $own $embree $ratio
  echo "  $1: own $2 s ($3 to $4), Embree $5 s ($6 to $7), ratio $8 ($9 to ${10})"
  echo "${8}" >"$work/kernel.ratio"
}

has_embree() {
  spd_draw "$work/kernel.embree.json" balls 0 --kernel embree 2>"$work/errors" && return
  sed 's/^raytracer: /  /; s/$/; as root: apt-get install libembree-dev, then build again/' "$work/errors"
  return 1
}

run_kernels() {
  echo "Rays per second of one core: the own kernel (double) against --kernel embree (float, robust, single rays), 512x512 in"
  echo "SPD's mode, $rounds rounds in turn. CPU time of the process while it renders: medians, least and greatest."
  has_embree || return 0
  local scene
  for scene in "${spd_scenes[@]}"; do
    kernel_rounds "$rounds" render $scene >"$work/kernel.rounds" || return 1
    kernel_line "$scene"
    verdict "$(<"$work/kernel.ratio")" 1.0 "$scene, render, own to Embree"
  done
}

run_large() {
  local scene times=$((rounds < 3 ? rounds : 3))
  echo "Large scenes: building and rendering, both on one thread, $times rounds in turn; CPU time of the process, medians."
  has_embree || return 0
  for scene in "balls 6" "tree 18" "rings 46"; do
    kernel_rounds $times both $scene >"$work/kernel.rounds" || return 1
    kernel_line "$scene"
    awk -v objects="$(figure "$work/kernel.bvh.json" objects)" -v bytes="$(figure "$work/kernel.bvh.json" model_bytes)" \
      -v read_s="$(figure "$work/kernel.bvh.json" load_s)" -v build_s="$(figure "$work/kernel.bvh.json" build_cpu_s)" \
      -v render="$(figure "$work/kernel.bvh.json" render_cpu_s)" 'BEGIN {
        printf "  own: %d objects, %d bytes; load %.2f s, build %.2f s, render %.2f s\n", objects, bytes, read_s, build_s, render
        printf "%.1f\n", bytes / objects > "/dev/fd/3" }' 3>"$work/kernel.bytes" || return 1
    verdict "$(<"$work/kernel.ratio")" 1.5 "$scene, build and render, own to Embree"
    verdict "$(<"$work/kernel.bytes")" 250 "$scene, bytes per object"
  done
}
