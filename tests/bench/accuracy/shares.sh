#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: shares.sh STIPPLE PLANTED
# Every mode of the clock counts all calls and gives every function about the share of the time that was planted in it.
# The tolerance is wide, and a machine that was busy with something else gets five tries.
set -u
stipple=$1 planted=$2 bad=0
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# try SHAPE CLOCK CALLS: regions that are off by more than a half and their interval, and a seventh of the run
try() {
  "$stipple" run -o "$work/a" --overwrite --clock "$2" -- "$planted" "$1" 300000 >"$work/out" 2>"$work/err" &&
    "$stipple" check "$work/a" >"$work/check" && "$stipple" stats "$work/a" --table profile --format csv >"$work/csv" ||
    { cat "$work/err" "$work/check"; echo "$1 $2: cannot be read"; return; }
  awk -f "$here/shares.awk" "$work/out" "$work/csv" >"$work/shares"
  awk -v name="$1 $2" -v expected="$3" '{ error = $4 < 0 ? -$4 : $4; calls += $6 }
    error > 0.5 + $5 && error * $2 > 0.15 { print name ": " $1 " has " $3 " of the time instead of " $2 }
    END { if (calls != expected) print name ": " calls " calls instead of " expected }' "$work/shares"
}

for shape in "mix 304689" "nested 300001" "bimodal 300001" "recursion 151012"; do
  read -r name calls <<<"$shape"
  for clock in exact sparse:8 budget:5; do
    for attempt in 1 2 3 4 5; do
      problems=$(try "$name" $clock "$calls")
      [ -z "$problems" ] && break
    done
    [ -z "$problems" ] || { echo "$problems"; bad=1; }
  done
done
exit $bad
