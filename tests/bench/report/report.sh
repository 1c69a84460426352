# SPDX-License-Identifier: MIT
# Sourced by tests/bench/run: what a report costs, its archive new to the reader, without a display.
run_report() {
  local events=${BENCH_REPORT_EVENTS:-1e8} archive=$work/report.stipple round
  echo "The report of an archive of $events function events on 9 ranks, which pass messages: CPU time and memory of the whole command, three times."
  echo "The archive is opened for the first time each time (what is kept beside it is removed)."
  "$build/tests/bench_store" write "$archive" "$events" 9 || return 1
  cat "$archive"/* >/dev/null
  for round in 1 2 3; do
    find "$archive" -type f ! -name '*.stream' -delete
    env -u DISPLAY /usr/bin/time -f '%U %S %M' -o "$work/report.time" "$build/bin/stipple" report "$archive" -o "$work/report.html" >/dev/null || return 1
    awk '{ print $1 + $2, $3 }' "$work/report.time"
  done | sort -n >"$work/report.rows"
  rm -r "$archive"
  verdict "$(awk 'NR == 2 { print $1 }' "$work/report.rows")" 3 "CPU seconds, median"
  verdict "$(sort -k2n "$work/report.rows" | awk 'NR == 2 { print int($2 / 1000) }')" 300 "MB resident at most, median"
  verdict "$(stat -c %s "$work/report.html")" 1000000 "bytes of the page"
}
