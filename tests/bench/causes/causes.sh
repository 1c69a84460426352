# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run: is the planted cause named, each program three times?
run_causes() {
  echo "Programs with a planted cause and healthy ones, three runs each: all must be right."
  local line
  "$here/../causes/check.sh" "$build/bin/stipple" "$build/tests/causes" --runs "${BENCH_CAUSES_RUNS:-3}" \
    --strength "${BENCH_STRENGTH:-1}" --load "${BENCH_LOAD:-0}" > "$work/causes"
  grep WRONG "$work/causes" | sed 's/^/  /'
  line=$(tail -1 "$work/causes")
  [[ $line =~ ^([0-9]+)\ of\ ([0-9]+)\ named\ first,\ ([0-9]+)\ of\ ([0-9]+)\  ]] || return 1
  verdict "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "planted causes named first" at-least
  verdict "${BASH_REMATCH[3]}" "${BASH_REMATCH[4]}" "healthy programs left in peace" at-least
  echo "  $line"
}
