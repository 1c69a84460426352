# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run. What dividing the objects costs on the simulated iPSC/2: at every share of the leaves that a
# node holds, and by what is held at equal memory. Everything is a function of the arguments but the CPU seconds.

declare -A study_scene=([teapot]="--scene teapot --scene-size 8" [rings]="--scene rings --scene-size 5"
  [balls]="--scene balls --object-limit 4096" [tree]="--scene tree --scene-size 10")

# usage: divided NODES SCENE ARGUMENTS...: sets seconds (simulated), cpu, and the files $work/d.stipple and $work/d.txt
divided() {
  local nodes=$1 scene=${study_scene[$2]} TIMEFORMAT='%U %S'
  shift 2
  { time "$build/bin/stipple" simulate --machine ipsc2 --nodes "$nodes" -o "$work/d.stipple" --overwrite \
    -- raytracer $scene --resolution 512x512 --samples 1 --partition bundles "$@" > "$work/d.txt" 2>&1; } 2> "$work/d.time"
  seconds=$(sed -nE 's/^simulated: ([0-9.]+) s.*/\1/p' "$work/d.txt")
  cpu=$(awk '{ print $1 + $2 }' "$work/d.time")
}

# usage: rays_per_message SECONDS: rays over messages with rays (tag 10) in $work/d.stipple, up to that time
rays_per_message() {
  local messages
  messages=$("$build/bin/stipple" stats "$work/d.stipple" --table types --to "$1" --format csv | awk -F, '$1 == 10 { print $2 }')
  "$build/bin/stipple" stats "$work/d.stipple" --table counters --to "$1" --format csv |
    awk -F, -v messages="$messages" '$3 == "rays sent" { rays += $7 } END { if (messages > 0) printf "%.1f", rays / messages }'
}

# usage: times SECONDS FLOOR
times() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.2f", a / b }'; }

run_divided() {
  [ -f "$build/lib/stipple/simulate/raytracer.so" ] || { echo "stipple simulate is not built: no SimGrid"; return; }
  local scene k share choice whole seconds before cpu most_cpu=0
  echo "Rays in a message, 8 nodes, one leaf each, but for the last 5 % of the run; in the whole run."
  for scene in teapot rings balls tree; do
    divided 8 "$scene" --objects partitioned --bundle 512
    printf '  %-8s in the whole run %s\n' "$scene" "$(rays_per_message "$seconds")"
    verdict "$(rays_per_message "$(awk -v s="$seconds" 'BEGIN { print 0.95 * s }')")" 64 "$scene, without the last 5 %" at-least
  done
  echo "Simulated seconds over those of a copy on each of 16 nodes, bundles of 512 modulo, k of 16 leaves each."
  for scene in teapot rings balls tree; do
    divided 16 "$scene" --objects replicated --bundle 512 --select modulo
    whole=$seconds
    printf '  %-8s %.0f s' "$scene" "$whole"
    for k in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do
      divided 16 "$scene" --objects partitioned --replicate "$(times "$k" 16.0)" --bundle 512 --select modulo
      printf ' %s' "$(times "$seconds" "$whole")"
      most_cpu=$(awk -v a="$most_cpu" -v b="$cpu" 'BEGIN { print a > b ? a : b }')
    done
    echo
  done
  echo "  the dearest of these runs took $most_cpu s of CPU"
  echo "Simulated seconds on 32 nodes over those of a copy on each, with so much of the scene's bytes on a node."
  for scene in teapot rings balls tree; do
    divided 32 "$scene" --objects replicated --bundle 512
    whole=$seconds
    for share in 0.25 0.5 0.75; do
      printf '  %-8s %s' "$scene" "$share"
      for choice in partitioned coupled; do
        before=$seconds
        divided 32 "$scene" --objects "$choice" --replicate "$share" --bundle 512
        printf ' %s %s (busiest %s)' "$choice" "$(times "$seconds" "$whole")" \
          "$(sed -nE 's/.*over the mean: ([0-9.]+).*/\1/p' "$work/d.txt")"
      done
      echo
      verdict "$(times "$seconds" "$before")" 0.99 "$scene $share, coupled over partitioned"
    done
  done
}
