#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: first_verdicts.sh STIPPLE
# From runs to the page, small: what is said, what is written, and that nothing is run twice.
set -eu
stipple=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
bad=0
fail() { echo "FAIL: $*"; bad=1; }

"$stipple" exemplar F12 --quick -o page >said 2>progress || { cat said progress; fail "exit status"; }
grep -qE '^F12: (holds|holds in part|refuted|unstable)' said || fail "no verdict: $(cat said)"
for file in F12.json F12-causes.csv F12-nodes.csv F12-nodes.svg F12-modern.svg index.html; do
  [ -s "page/$file" ] || fail "no $file"
done
grep -q 'section class="experiment" id="F12"' page/index.html || fail "F12 is not on the page"
! grep -qE '(src|href)="?http' page/index.html || fail "the page needs something from outside"
# Reference, more work, a slow host, the cluster of today: two sizes each.
runs=$(ls page/runs/*.json | wc -l)
[ "$runs" = 8 ] || fail "$runs runs were kept"
[ -z "$(ls page/runs | grep -v json)" ] || fail "more than measures is left: $(ls page/runs)"

# Interrupted after all runs but one, it goes on with that one and says the same.
mv page/index.html before.html
rm "$(ls page/runs/*.json | head -1)"
"$stipple" exemplar F12 --quick -o page >again 2>progress
grep -q 'F12: 1 of 1 runs' progress || fail "not one run was made: $(cat progress)"
cmp said again && cmp before.html page/index.html || fail "the second time it is another page"

# Errors of use.
refuses() {
  local text=$1; shift
  "$@" >out 2>&1 && fail "$* is accepted"
  grep -q -- "$text" out || { fail "$* does not say '$text'"; cat out; }
}
refuses "no experiment 'F999'; there are" "$stipple" exemplar F12 F999 -o x
refuses "has a page of its own" "$stipple" exemplar F12 speed-accuracy -o x
refuses "machine" "$stipple" exemplar F12 --quick --machine abacus -o x
[ $bad = 0 ] && echo "judged, kept and drawn: $(head -1 said)"
exit $bad
