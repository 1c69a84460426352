#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: page_in_browser.sh SAMPLE_REPORTS STIPPLE DATA
# Reports opened in a browser: nothing on its console; tables, pages, zoom and keys work (page_driver.js), light and dark; a part
# of the run says what `stipple stats` says of it; without scripts and on paper everything is there. Exit 77: no browser that
# works here.
set -u
samples=$1 stipple=$2 archives=$3 here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "needs chromium"; exit 77; }
# browser ARGUMENTS...: what it says goes to $work/err.
browser() {
  timeout 120 "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/profile" \
    --enable-logging=stderr --window-size=1400,1000 "$@" 2>"$work/err"
}
browser --dump-dom about:blank | grep -q '<html' || { echo "$chromium does not work here"; exit 77; }
bad=0
fail() { echo "FAIL: $*"; bad=1; }

# take PAGE...: to be driven with the others of one start of the browser, each in a frame of its own.
taken=()
take() {
  local page
  for page in "$@"; do
    { cat "$page"; echo "<script>"; cat "$here/page_driver.js"; echo "</script>"; } >"$work/driven/$(basename "$page")"
    taken+=("$(basename "$page" .html)")
  done
}
# drive NOTE [FLAG...]: all that were taken; each page's driver says what it found on the console, where nothing else may stand.
drive() {
  local note=$1 name
  shift
  for name in "${taken[@]}"; do echo "<iframe src=driven/$name.html width=1400 height=1000></iframe>"; done >"$work/frames.html"
  browser "$@" --dump-dom "file://$work/frames.html" >/dev/null
  if grep CONSOLE "$work/err" | grep -v '"DRIVEN '; then fail "a message on the console$note"; fi
  for name in "${taken[@]}"; do
    grep -qF "\"DRIVEN $name: none" "$work/err" ||
      fail "$name$note: $(grep -o "\"DRIVEN $name: .*" "$work/err" || echo "the script did not end")"
  done
  taken=()
}

# on_paper PAGE NAME [FLAG...]: every page's heading and every panel's stand in the PDF.
on_paper() {
  local page=$1 name=$2 heading
  shift 2
  command -v pdftotext >/dev/null || return 0
  browser "$@" --no-pdf-header-footer --print-to-pdf="$work/page.pdf" "file://$page" >/dev/null
  pdftotext -layout "$work/page.pdf" - 2>/dev/null | tr -s ' \n' ' ' >"$work/text"
  grep -oE '<h[123][^>]*>[^<]*' "$page" | sed 's/.*>//; s/&amp;/\&/g; s/&lt;/</g; s/&gt;/>/g' | while read -r heading; do
    grep -qF -e "$heading" "$work/text" || echo "$heading"
  done >"$work/missing"
  [ -s "$work/missing" ] && fail "$name: not on paper: $(tr '\n' ';' <"$work/missing")"
  return 0
}

mkdir "$work/pages" "$work/driven"
"$samples" "$work/pages" >"$work/samples" || fail "sample_reports: $?"
take "$work/pages/nine.html"
drive " in the dark" --force-dark-mode --blink-settings=preferredColorScheme=0
on_paper "$work/pages/nine.html" nine
on_paper "$work/pages/thousand.html" thousand
perl -0pe 's/<script.*?<\/script>//gs' "$work/pages/nine.html" >"$work/still.html"
on_paper "$work/still.html" "nine without scripts"
take "$work"/pages/*.html

# A run that was recorded.
"$stipple" report "$archives/format-1.stipple" -o "$work/run.html" >/dev/null || fail "stipple report: $?"
"$stipple" compare "$archives/format-1.stipple" "$archives/format-1-compacted.stipple" -o "$work/both.html" >/dev/null ||
  fail "stipple compare: $?"
take "$work/run.html" "$work/both.html"

# Archives that lack something, or nearly all, give a page all the same, which says so.
mkdir "$work/empty.stipple"
for kind in damaged cut zero; do cp -r "$archives/format-1.stipple" "$work/$kind.stipple"; done
for stream in "$work"/damaged.stipple/*.stream; do
  printf 'XXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXX' | dd of="$stream" bs=1 seek=20000 conv=notrunc status=none
done
for stream in "$work"/cut.stipple/*.stream; do truncate -s 30000 "$stream"; done
for stream in "$work"/zero.stipple/*.stream; do truncate -s 0 "$stream"; done
for kind in empty damaged cut zero; do
  "$stipple" report "$work/$kind.stipple" -o "$work/$kind.html" >"$work/out" 2>&1
  status=$?
  [ $status = 0 ] || { [ $status = 2 ] && ! [ -e "$work/$kind.html" ] && grep -q . "$work/out"; } || fail "$kind: exit $status: $(cat "$work/out")"
  if [ -e "$work/$kind.html" ]; then take "$work/$kind.html"; fi
done
drive ""

# The second and third quarter of the run that was recorded, as the page shows it and as the table says it.
span=$("$stipple" info --json "$archives/format-1.stipple" | grep -oE '"span_s": ?[0-9.e-]+' | grep -oE '[0-9.e-]+$')
"$stipple" stats "$archives/format-1.stipple" --table states --format csv --from "$(awk "BEGIN{printf \"%.9f\", $span/4}")" \
  --to "$(awk "BEGIN{printf \"%.9f\", $span*3/4}")" 2>/dev/null | tail -n +2 | cut -d, -f2- >"$work/table"
grep -o '"DRIVEN run: .*' "$work/err" | grep -oE '\[[^][]*\]' | tr -d '[]' >"$work/page"
[ -s "$work/page" ] || fail "the page has no states of a part"
paste -d, "$work/table" "$work/page" | awk -F, -v span="$span" '
  { n = NF / 2; for (i = 1; i <= n; ++i) { if ($i == "") continue; d = $i - $(i + n); if (d < 0) d = -d
      if (d > span / 2000) { print "state " i " of row " NR ": " $i " in the table, " $(i + n) " on the page"; bad = 1 } } }
  END { exit bad }' || fail "the range does not show what the table says"
[ $bad = 0 ] && echo "pages work in $("$chromium" --version)"
exit $bad
