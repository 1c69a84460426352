# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run. What a simulated run costs against how well it foretells two real ranks of this machine:
# work charged by tests, by rays, or each ray alike, at full size and at fewer pixels. PREDICTION_CSV names the file to
# write (docs/stipple-exemplar.md has its form; `stipple exemplar speed-accuracy --from` draws it).

prediction_partitions=("tiled" "scattered" "guided" "bundles --bundle 512")
# What a unit of work costs, in picoseconds: box test, primitive test, ray, shadow ray. Their sum is set by one real rank.
declare -A prediction_prices=(["by tests"]="" ["by rays"]=0,0,350000,250000 ["rays alike"]=0,0,300000,300000)

# usage: prediction_simulated PRICES NODES SCALE ARGUMENTS: seconds of rendering in $simulated_s, the simulator's in $simulated_cpu
prediction_simulated() {
  local prices=$1 nodes=$2 scale=$3
  shift 3
  STIPPLE_PRICES=$prices simulated "$work/one" --machine modern --nodes "$nodes" --work-scale "$scale" -o "$work/s.stipple" \
    --overwrite --json -- raytracer "$@" --samples 1 --stats "$work/simulated.json"
  simulated_s=$(json_figure "$work/simulated.json" render_s)
  simulated_cpu=$(cat "$work/one.cpu")
}

# usage: prediction_measure SCENE: least seconds of rendering, of one real rank in $prediction_one, of two by partition in
# $prediction_truth. They take turns, alone on their processors where that is allowed: what disturbs one disturbs all.
prediction_measure() {
  local scene=$1 round i first=()
  chrt -f 1 true 2> "$work/chrt" && first=(chrt -f 1)
  rm -f "$work"/real.s.*
  for ((round = 0; round < rounds; ++round)); do
    for i in one "${!prediction_partitions[@]}"; do
      local ranks=2 partition=tiled
      if [ "$i" = one ]; then ranks=1; else partition=${prediction_partitions[i]}; fi
      "${first[@]}" mpirun -n $ranks --bind-to core "$build/bin/raytracer-bare" $scene --resolution 512x512 --samples 1 \
        --partition $partition --stats "$work/real.json" > "$work/real.txt" || return 1
      json_figure "$work/real.json" render_s >> "$work/real.s.$i"
    done
  done
  prediction_one=$(sort -g "$work/real.s.one" | head -1)
  prediction_truth=()
  for i in "${!prediction_partitions[@]}"; do prediction_truth+=("$(sort -g "$work/real.s.$i" | head -1)"); done
}

# usage: prediction_point PANEL SERIES WIDTH PRICES SCALE SCENE: a line of the file
prediction_point() {
  local panel=$1 series=$2 width=$3 prices=$4 scale=$5 scene=$6 partition nodes i=0
  for partition in "${prediction_partitions[@]}"; do
    nodes=2
    [[ $partition == bundles* ]] && nodes=1  # and a host
    prediction_simulated "$prices" "$nodes" "$scale" $scene --resolution "${width}x$width" --partition $partition
    echo "$simulated_s ${prediction_truth[i]} $simulated_cpu"
    ((++i))
  done > "$work/errors"
  awk -v panel="$panel" -v series="$series" -v width="$width" '
    { ratio = $1 * (512 / width) ^ 2 / $2; error = ratio > 1 ? ratio - 1 : 1 - ratio; sum += error; cpu += $3
      if (error > worst) worst = error; ratios = ratios sprintf(",%.4f", ratio) }
    END { label = series == "by tests" && width != 256 ? width "x" width : ""  # more would overlap
          printf "%s,%s,%s,%.4f,%.5f,%d,%.5f%s\n", panel, series, label, cpu / NR, sum / NR,
                 series == "by tests" && width == 128, worst, ratios }' "$work/errors"
}

# usage: prediction_scale PRICES SCENE: what makes a simulated node as fast as one real rank
prediction_scale() {
  prediction_simulated "$1" 1 1 $2 --resolution 256x256
  awk -v real="$prediction_one" -v simulated="$simulated_s" 'BEGIN { print real / (4 * simulated) }'
}

run_prediction() {
  [ -f "$build/lib/stipple/simulate/raytracer.so" ] || { echo "stipple simulate is not built: no SimGrid"; return; }
  echo "Simulated against measured seconds of two ranks, mean over tiled, scattered, guided, bundles; CPU seconds of the simulator."
  local scene panel charge scale width points=$work/points
  : > "$points"
  for scene in "--scene teapot --scene-size 8" "--scene rings --scene-size 5"; do
    panel=$(cut -d' ' -f2 <<< "$scene")
    prediction_measure "$scene" || return 1
    echo "  $panel: one rank $prediction_one s, two $(paste -d' ' <(printf '%s\n' "${prediction_partitions[@]}") <(printf '%s s\n' "${prediction_truth[@]}") | paste -sd,)"
    for charge in "by tests" "by rays" "rays alike"; do
      scale=$(prediction_scale "${prediction_prices[$charge]}" "$scene")
      for width in 64 128 256 512; do
        [ "$charge" = "by tests" ] || [ $width -lt 512 ] || continue  # others are as far off with more pixels
        prediction_point "$panel" "$charge" "$width" "${prediction_prices[$charge]}" "$scale" "$scene"
      done
    done >> "$points"
    prediction_point "$panel" "shipped prices" 256 "" 1 "$scene" >> "$points"
  done
  prediction_table "$points" > "${PREDICTION_CSV:-$work/prediction.csv}"
  sed -n 's/^# sentence: /  /p' "${PREDICTION_CSV:-$work/prediction.csv}"
  sed 's/^/  /' "$points"
}

prediction_table() { # POINTS
  echo "# title: Simulating two ranks"
  awk -F, '
    function most(a, b) { return a > b ? a : b }
    $6 == 1 { least = least == "" || $5 < least ? $5 : least; taken_most = most(taken_most, $5); taken += $4 }
    $2 == "by tests" && $3 ~ /^512x/ { full += $4; full_most = most(full_most, $5) }
    $2 == "rays alike" { alike = most(alike, $5) }
    $2 == "shipped prices" { shipped = most(shipped, $5) }
    END { printf "# sentence: Simulate a sixteenth of the pixels, at the speed of one measured rank: %.1f to %.1f %% from the times of two real ranks, for %.2f of the CPU time of all pixels, which miss by up to %.1f %%; charging every ray alike misses by up to %.1f %%, the shipped prices without that measurement by up to %.1f %%.\n",
          100 * least, 100 * taken_most, taken / full, 100 * full_most, 100 * alike, 100 * shipped }' "$1"
  echo "# effort: 512 x 512 pixels, real times: least of $rounds runs; mean of four partitions; $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1)"
  echo "# kind: xy"
  echo "# x: cpu_s, CPU seconds of the simulator for a run"
  echo "# y: error, simulated from measured time, of 1"
  echo "panel,series,label,cpu_s,error,recommended,worst,tiled,scattered,guided,bundles"
  cat "$1"
}
