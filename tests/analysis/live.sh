#!/bin/bash
# SPDX-License-Identifier: MIT
# live.sh STIPPLE LIVE_WRITER: every command reads an archive that is being written, says so, and finds no fault in it.
set -u
stipple=$1 writer=$2
work=$(mktemp -d)
pid=
trap '[ -z "$pid" ] || kill -KILL "$pid"; rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
mkdir live.stipple
STIPPLE_ARCHIVE=$work/live.stipple STIPPLE_CLOCK=exact "$writer" &
pid=$!
# expect TEXT COMMAND...: exit status 0, TEXT on one of the outputs.
expect() {
  "$stipple" "${@:2}" >out 2>&1 || fail "${*:2}: exit $?: $(tail -3 out)"
  grep -q "$1" out || fail "${*:2}: no '$1' in $(head -3 out)"
}
until [ -n "$(ls live.stipple)" ]; do sleep 0.01; done
for round in 1 2 3; do
  expect "sound, .* still running: recorded until" check live.stipple
  expect "no event lost, still running: recorded until" info live.stipple
  expect '"running":1,"problems":\[\]' info --json live.stipple
  expect "still running: recorded until" stats live.stipple --table profile
  expect "still running: recorded until" print --to 0.0001 live.stipple
  [ ! -e "$(dirname "$stipple")/../lib/stipple/libstipple-views.so" ] ||
    { expect "still running: recorded until" report live.stipple -o live.html
      grep -q "still running: recorded until" live.html || fail "round $round: the report does not say it"; }
done
"$stipple" compact live.stipple >out 2>&1 && fail "compacted under its writer"
grep -q "its process is still running" out || fail "compact does not say why"
kill -KILL "$pid"
wait "$pid" 2>/dev/null
pid=
"$stipple" check live.stipple >out && fail "a killed process is none"
grep -q "did not end in order" out || fail "check: $(cat out)"
"$stipple" compact live.stipple >out || fail "compact after the kill: $(cat out)"
exit "$failures"
