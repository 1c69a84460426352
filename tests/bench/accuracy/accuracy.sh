# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run: speed against accuracy. Every mode of the clock records programs that know how long they
# are in each function. ACCURACY_VISITS (default 3e6) and BENCH_ROUNDS (at most 5 here) make it shorter or longer;
# ACCURACY_CHART names the picture to write.

# One run of planted, alone on its processor where that is allowed: in wall time nothing else may be measured.
planted() { # OUT SHAPE [VARIABLE=VALUE...]
  local first=()
  chrt -f 1 true 2>/dev/null && first=(chrt -f 1)
  env "${@:3}" "${first[@]}" "$build/tests/planted" "$2" "${ACCURACY_VISITS:-3000000}" >"$1" || { cat "$1" >&2; return 1; }
}

# Line "clock,shape,percent,ns_per_event,median_error,worst_error,outside" of one traced run.
planted_figures() { # CLOCK SHAPE PLAIN_OUT
  rm -rf "$work/planted.stipple" && mkdir "$work/planted.stipple" || return 1
  planted "$work/traced" "$2" STIPPLE_ARCHIVE="$work/planted.stipple" STIPPLE_CLOCK="$1" \
    LD_PRELOAD="$build/lib/stipple/libstipple.so" || return 1
  "$build/bin/stipple" stats "$work/planted.stipple" --table profile --format csv >"$work/profile" || return 1
  awk -f "$(dirname "$0")/accuracy/shares.awk" "$work/traced" "$work/profile" | sort -k2,2nr >"$work/shares"
  [ -z "${ACCURACY_DETAILS:-}" ] || sed "s/^/    $1 $2 /" "$work/shares" >&2
  awk -v clock="$1" -v shape="$2" '
    FILENAME == ARGV[1] { if ($1 == "cpu_ns") plain = $2; next }
    FILENAME == ARGV[2] { if ($1 == "cpu_ns") traced = $2; next }
    { error = $4 < 0 ? -$4 : $4; errors[++n] = error; calls += $6
      if (error > worst) worst = error
      if (error > 0.02 + $5) ++outside }
    END {
      for (i = 2; i <= n; ++i) { x = errors[i]; for (j = i - 1; j > 0 && errors[j] > x; --j) errors[j + 1] = errors[j]; errors[j + 1] = x }
      printf("%s,%s,%.3f,%.3f,%.6f,%.6f,%d,%d\n", clock, shape, (traced / plain - 1) * 100, (traced - plain) / calls / 2,
             (errors[int((n + 1) / 2)] + errors[int(n / 2) + 1]) / 2, worst, outside, n) }' "$3" "$work/traced" "$work/shares"
}

run_accuracy() {
  echo "Programs with planted work in every mode of the clock; the truth is the share of the work that each function has."
  local clocks=(exact sparse:8 sparse:64 budget:1 budget:5 budget:20) shapes=(mix nested callers bimodal recursion period)
  local round clock shape rounds_here=$((rounds < 5 ? rounds : 5))
  : >"$work/figures"
  for ((round = 0; round < rounds_here; ++round)); do
    for shape in "${shapes[@]}"; do
      for clock in "${clocks[@]}"; do
        planted "$work/plain" "$shape" && planted_figures "$clock" "$shape" "$work/plain" >>"$work/figures" || return 1
      done
    done
  done
  # Of each clock and shape the medians over the rounds, then a line for each clock.
  awk -F, '
    function median(list, count, values, i, j, x) {
      count = split(list, values, " ")
      for (i = 2; i <= count; ++i) { x = values[i] + 0; for (j = i - 1; j > 0 && values[j] + 0 > x; --j) values[j + 1] = values[j]; values[j + 1] = x }
      return (values[int((count + 1) / 2)] + values[int(count / 2) + 1]) / 2
    }
    { key = $1 "," $2; if (!(key in percent)) keys[++n] = key
      percent[key] = percent[key] " " $3; ns[key] = ns[key] " " $4; error[key] = error[key] " " $5; worst[key] = worst[key] " " $6 }
    END {
      for (i = 1; i <= n; ++i) { k = keys[i]; printf("%s,%.3f,%.3f,%.6f,%.6f\n", k, median(percent[k]), median(ns[k]), median(error[k]), median(worst[k])) }
    }' "$work/figures" >"$work/medians"
  echo "  clock       added CPU %         ns per event        error of exclusive times     beyond 2 % + interval"
  echo "              median  worst       median  worst       median %  worst %            of functions over 1 %"
  for clock in "${clocks[@]}"; do
    awk -F, -v clock="$clock" '
      FILENAME == ARGV[1] { if ($1 != clock) next; p[++n] = $3; e[n] = $4; m[n] = $5; if ($6 > w) w = $6; next }
      $1 == clock { outside += $7; all += $8 }
      function sorted(v, i, j, x) { for (i = 2; i <= n; ++i) { x = v[i]; for (j = i - 1; j > 0 && v[j] > x; --j) v[j + 1] = v[j]; v[j + 1] = x } return (v[int((n + 1) / 2)] + v[int(n / 2) + 1]) / 2 }
      END { pm = sorted(p); em = sorted(e); mm = sorted(m)
        printf("  %-10s %7.2f %6.2f      %7.2f %6.2f      %8.2f %8.2f            %d of %d\n", clock, pm, p[n], em, e[n], mm * 100, w * 100, outside, all) }' \
      "$work/medians" "$work/figures"
  done
  verdict "$(awk -F, '$1 == "budget:5" { outside += $7 } END { print outside + 0 }' "$work/figures")" 0 "budget:5, functions beyond 2 % plus their interval"
  if [ -n "${ACCURACY_CHART:-}" ]; then "$build/tests/bench_accuracy_chart" "$work/medians" "$ACCURACY_CHART"; fi
}
