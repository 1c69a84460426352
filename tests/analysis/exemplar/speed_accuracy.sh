#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: speed_accuracy.sh STIPPLE RAYTRACER_CHARTS
# A quick run from measuring to the page. Times differ from run to run; errors and which points there are must not.
set -eu
stipple=$1 charts=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
bad=0
fail() { echo "FAIL: $*"; bad=1; }

"$stipple" exemplar speed-accuracy --quick -o page >said
names=$("$charts" --help | sed -n '/^Charts:/,$s/^  \([a-z]*\) .*/\1/p')
[ "$(wc -w <<<"$names")" -ge 3 ] || fail "raytracer-charts --help names only: $names"
for name in $names; do
  [ -s "page/$name.csv" ] && [ -s "page/$name.svg" ] || { fail "no $name.csv or $name.svg"; continue; }
  grep -q "^$name: ." said || fail "no sentence about $name"
  grep -q "<section [^>]*id=\"$name\"" page/index.html || fail "$name is not on the page"
  xmllint --noout "page/$name.svg" 2>/dev/null || ! command -v xmllint >/dev/null || fail "$name.svg is not well-formed"
  # In each panel one point is to be taken; of a map, a whole panel may be.
  awk -F, '/^# kind: map/ { map = 1 } /^#/ { next } /^panel,/ { next }
    { panel[$1]; taken[$1] += $6; points[$1]++; all += $6 }
    END { if (all == 0) exit 1; if (!map) for (p in panel) if (taken[p] != 1) exit 1 }' "page/$name.csv" ||
    fail "$name: not one recommended point in each panel"
done

# More rays, less error.
awk -F, '$2 == "stratified" { if ($1 == panel && !($5 < error)) { print; wrong = 1 } panel = $1; error = $5; n++ }
  END { exit wrong || n < 8 }' page/sampling.csv || fail "the error of stratified rays does not fall with their number"

# Measured again, the same but for the times, and drawn from what was measured.
"$charts" sampling quadrics precision --quick -o again >/dev/null
for name in sampling quadrics precision; do
  diff <(grep -v '^#' "page/$name.csv" | cut -d, -f1-3,5-) <(grep -v '^#' "again/$name.csv" | cut -d, -f1-3,5-) >differ ||
    { fail "$name: errors differ between runs"; cat differ; }
done
"$stipple" exemplar speed-accuracy --from again -o drawn >/dev/null
[ "$(ls drawn | tr '\n' ' ')" = "index.html precision.svg quadrics.svg sampling.svg " ] || fail "--from made: $(ls drawn)"

# Errors of use.
refuses() {
  local text=$1; shift
  "$@" >out 2>&1 && fail "$* is accepted"
  grep -q -- "$text" out || { fail "$* does not say '$text'"; cat out; }
}
refuses "no experiment 'nonsense'; there are" "$stipple" exemplar nonsense -o x
refuses "no chart 'nonsense'; there are" "$charts" nonsense -o x
refuses "no CSV files" "$stipple" exemplar speed-accuracy --from drawn -o x
[ $bad = 0 ] && echo "measured and drawn: $(echo $names)"
exit $bad
