#!/bin/sh
# SPDX-License-Identifier: MIT
# plot.sh STIPPLE PROGRAM ARGS...: every view of a real run as SVG, PDF and PNG, without a display; twice the same bytes; what does
# not fit is refused with what does. PROGRAM is an MPI program built with the plugin.
set -u
stipple=$1; shift
unset DISPLAY
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
has() { grep -qe "$2" "$1" || { fail "no '$2' in $1"; cat "$1"; }; }

"$stipple" run -o a.stipple -- mpirun --oversubscribe -n 4 "$@" >/dev/null 2>run.err || { cat run.err; exit 77; }

views=$("$stipple" plot --help | sed -n '/^Views/,/^Tables/s/^  \([a-z]*\) .*/\1/p')
[ "$(echo "$views" | wc -w)" -ge 13 ] || fail "views are only: $views"
for view in $views; do
  for end in svg pdf png; do
    "$stipple" plot a.stipple --view "$view" -o "$view.$end" >out 2>err || { fail "$view.$end"; cat err; continue; }
    has out "^$view.$end$"
    # All are drawn from the SVG: of two views is enough.
    [ $end = svg ] || [ "$view" = timeline ] || [ "$view" = dials ] || continue
    "$stipple" plot a.stipple --view "$view" -o again.$end >/dev/null 2>&1
    cmp -s "$view.$end" again.$end || fail "$view.$end has other bytes the second time"
  done
  head -c 4 "$view.pdf" | grep -q '%PDF' || fail "$view.pdf is no PDF"
  head -c 4 "$view.png" | grep -q 'PNG' || fail "$view.png is no PNG"
  has "$view.svg" '<svg xmlns'
  grep -q 'Nothing to show' "$view.svg" && fail "$view shows nothing"
done
"$stipple" plot a.stipple --view timeline --mono -o mono.svg >/dev/null 2>&1 || fail "mono"
has mono.svg 'url(#mono-message)\|#6b6b6b'
grep -q '#3672b9' mono.svg && fail "mono.svg has the colour of a state"

# Text of a PDF can be selected.
if command -v pdftotext >/dev/null; then
  pdftotext timeline.pdf - | grep -q 'State of each' || fail "timeline.pdf has no text"
fi

# Several tables; another table than by itself; a moment.
"$stipple" plot a.stipple --view kiviat --table messages,volume --at 0.001 -o k.svg >out 2>err || { fail kiviat; cat err; }
has k.svg 'volume sent'
"$stipple" plot a.stipple --view graph --table states --x user_s --y idle_s -o g.svg >out 2>err || { fail graph; cat err; }

# What does not fit.
expect2() { "$stipple" plot a.stipple "$@" >out 2>err; [ $? -eq 2 ] || { fail "$* was not refused"; cat out err; }; }
expect2 --view kiviat --table callpaths; has err "views that fit it: flame"; has err "tables that fit 'kiviat':.* states"
expect2 --view nonsense; has err "known: timeline matrix bars"
expect2 --view bars --table nonsense; has err "known: profile"
expect2 --view timeline --table states; has err "shows no table"
expect2 --view bars -o x.gif; has err ".svg .pdf .png"
expect2 --view bars --y nonsense; has err "columns: rank user_s"

# Nothing to show is no error.
mkdir empty.stipple
for view in $views; do
  "$stipple" plot empty.stipple --view "$view" -o e.svg >out 2>err || { fail "$view of an empty archive"; cat err; }
done
[ $failures = 0 ] && echo "all views as SVG, PDF and PNG"
exit $((failures > 0))
