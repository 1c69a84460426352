# SPDX-License-Identifier: MIT
# Part of tests/bench/run: an archive opened the first and the second time.

# A number of a line of bench_store that begins with this word.
store_value() { # FILE LINE NAME
  awk -v line="$2" -v name="$3" '$1 == line { for (i = 2; i < NF; ++i) if ($i == name) print $(i + 1) }' "$1"
}

run_store() {
  local events=${BENCH_STORE_EVENTS:-1e8} directory=${BENCH_STORE_DIRECTORY:-$work}
  local archive=$directory/store.stipple
  echo "An archive of $events function events on 9 ranks, a message per 1000 of them, opened as far as a picture of 1000 columns;"
  echo "each time by a fresh process, resident memory at its most. BENCH_STORE_EVENTS=1e9 needs 8 GB in BENCH_STORE_DIRECTORY."
  rm -rf "$archive"
  "$build/tests/bench_store" write "$archive" "$events" 9 || return 1
  sleep 1  # what has just changed gets no index
  "$build/tests/bench_store" open "$archive" | tee "$work/store_first" || return 1
  "$build/tests/bench_store" open "$archive" | tee "$work/store_second" || return 1
  echo "  index: $(stat -c %s "$archive/analysis.index") bytes"
  verdict "$(store_value "$work/store_second" second wall_s)" 1 "second opening, s to the first picture"
  verdict "$(store_value "$work/store_second" second rss_mb)" 200 "second opening, MB resident"
  "$build/bin/stipple" compact "$archive" | sed 's/^.*stipple:/  compacted:/' || return 1
  sleep 1
  "$build/tests/bench_store" open "$archive" | grep first || return 1
  "$build/tests/bench_store" open "$archive" | grep second | tee "$work/store_compacted" || return 1
  verdict "$(store_value "$work/store_compacted" second wall_s)" 1 "compacted, the same"
  verdict "$(store_value "$work/store_compacted" second rss_mb)" 200 "compacted, the same"
  rm -rf "$archive"
}
