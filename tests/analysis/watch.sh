#!/bin/bash
# SPDX-License-Identifier: MIT
# watch.sh STIPPLE LIVE_WRITER: stipple watch waits for an archive, shows page after page of a run that goes on, ends with
# it, and on a terminal draws in place and gives the terminal back.
set -u
stipple=$1 writer=$2
work=$(mktemp -d)
pids=
trap 'for p in $pids; do kill -KILL "$p" 2>/dev/null; done; rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
# until_has FILE TEXT: however busy the machine is.
until_has() {
  for _ in $(seq 3000); do grep -q "$2" "$1" 2>/dev/null && return; sleep 0.02; done
  fail "no '$2' in $1: $(tail -5 "$1")"
}
start_writer() {
  mkdir -p "$1"
  STIPPLE_ARCHIVE=$work/$1 STIPPLE_CLOCK=exact "$writer" &
  writer_pid=$!
  pids+=" $writer_pid"
}

"$stipple" watch --once none.stipple 2>err && fail "--once of nothing"
grep -q "none.stipple.*not there" err || fail "--once does not say what is missing"
for wrong in "--interval 0" "--interval -1" "--window -1" "--table nonsense"; do
  "$stipple" watch live.stipple $wrong >out 2>&1
  [ $? -eq 2 ] || fail "$wrong was taken"
done

# Without a terminal: waiting, said once; pages; the end with the run.
"$stipple" watch live.stipple --interval 0.1 >pages 2>err &
watch=$!
pids+=" $watch"
until_has pages "waiting for live.stipple"
start_writer live.stipple
until_has pages "running, recorded until"
"$stipple" watch --once live.stipple >once 2>/dev/null || fail "--once"
[ "$(grep -c "running, recorded until" once)" = 1 ] || fail "--once: $(cat once)"
"$stipple" watch --once --table profile live.stipple >once 2>/dev/null || fail "--table"
grep -q "^region .*exclusive_s" once || fail "--table: $(cat once)"
for _ in $(seq 3000); do [ "$(grep -c "running, recorded until" pages)" -ge 2 ] && break; sleep 0.02; done
[ "$(grep -c "running, recorded until" pages)" -ge 2 ] || fail "one page only"
kill -KILL "$writer_pid"
wait "$writer_pid" 2>/dev/null
wait "$watch" || fail "watch did not end in order"
grep -q "ended at" pages || fail "no last page"
[ "$(grep -c "waiting for" pages)" = 1 ] || fail "waiting was said again"
grep -q "most time itself" pages || fail "no regions"
grep -q "$(printf '\033')" pages && fail "codes of a terminal in a file"

# A signal ends it.
start_writer more.stipple
"$stipple" watch more.stipple --interval 0.1 >pages 2>err &
watch=$!
pids+=" $watch"
until_has pages "running, recorded until"
kill -INT "$watch"  # of a background process of a script: not ignored
wait "$watch" || fail "SIGINT: exit $?"

# On a terminal: drawn in place, in its size, q quits, the first screen and the cursor come back.
if command -v script >/dev/null; then
  { until grep -q "running, recorded" typed 2>/dev/null; do sleep 0.05; done; sleep 0.3; printf q; } |
    TERM=xterm COLORTERM=truecolor timeout 60 script -qefc "stty cols 90 rows 20; '$stipple' watch more.stipple --interval 0.1" typed \
      >/dev/null 2>&1 || fail "on a terminal: exit $?"
  python3 - <<'PY' || fail "what the terminal got"
import re, sys
text = open("typed", errors="replace", newline="").read()
assert "\x1b[?1049h" in text and text.index("\x1b[?1049h") < text.index("\x1b[H"), "second screen"
assert text.index("\x1b[?1049l") > text.rindex("\x1b[H"), "first screen again"
assert "\x1b[?25h" in text, "cursor"
assert "\x1b[48;2;54;114;185m" in text, "the colour of user time"
page = text.split("\x1b[H")[1].split("\x1b[?")[0]
lines = [re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", l).rstrip("\r") for l in page.split("\r\n")]
assert len(lines) <= 20, len(lines)
assert all(len(l) <= 90 for l in lines), max(map(len, lines))
PY
fi
exit "$failures"
