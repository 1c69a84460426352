#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: page_in_browser.sh SAMPLE_REPORTS
# Reports opened in a browser: nothing on its console, tables sort, values appear under the pointer. Exit 77: no browser
# that works here.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "needs chromium"; exit 77; }
# As it stands after its scripts have run; what they say, and no more, is a line with CONSOLE.
opened() {
  "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/profile" \
    --enable-logging=stderr --dump-dom "$1" 2>"$work/err"
}
opened about:blank | grep -q '<html' || { echo "$chromium does not work here"; exit 77; }

cat >"$work/driver.js" <<'END'
(function () {
  var problems = [], tables = document.querySelectorAll("table.sortable"), sorted = 0;
  function values(table, column) {
    return Array.from(table.tBodies[0].rows, function (row) {
      var cell = row.cells[column];
      return "v" in cell.dataset ? cell.dataset.v : cell.textContent;
    }).filter(function (value) { return value !== ""; });
  }
  function inOrder(list, text, sign) {
    return list.every(function (value, i) {
      if (i === 0) return true;
      return sign * (text ? list[i - 1].localeCompare(value, "en", {numeric: true}) : list[i - 1] - value) <= 0;
    });
  }
  tables.forEach(function (table) {
    table.querySelectorAll("thead th button").forEach(function (button) {
      var head = button.parentNode, text = head.dataset.sort === "text";
      for (var click = 0; click < 2; ++click) {
        button.click();
        var sign = head.getAttribute("aria-sort") === "descending" ? -1 : 1;
        if (sign !== ((click === 0) === text ? 1 : -1)) problems.push("wrong way: " + button.textContent);
        if (!inOrder(values(table, head.cellIndex), text, sign)) problems.push("not sorted: " + button.textContent);
        ++sorted;
      }
    });
  });
  if (tables.length > 0 && sorted === 0) problems.push("no table sorts");
  var source = document.getElementById("hover"), svg = document.querySelector("svg.view-timeline");
  var data = source && svg ? JSON.parse(source.textContent) : {};
  (data.rows || []).forEach(function (row) {
    var area = svg.getBoundingClientRect(), scale = area.width / svg.viewBox.baseVal.width;
    svg.dispatchEvent(new PointerEvent("pointermove", {
      clientX: area.left + scale * (data.left + data.right) / 2, clientY: area.top + scale * (row[1] + row[2] / 2)}));
    var tip = document.getElementById("tip"), shares = 0;
    tip.innerHTML.replace(/(\d+)%/g, function (all, share) { shares += Number(share); });
    if (tip.hidden || !tip.textContent.startsWith(row[0])) problems.push("no values for " + row[0]);
    if (Math.abs(shares - 100) > 3) problems.push("shares of " + row[0] + " make " + shares + "%");
  });
  document.body.dataset.problems = problems.join("; ") || "none";
})();
END

"$1" "$work" >"$work/samples"
bad=0
for page in "$work"/*.html; do
  name=$(basename "$page" .html)
  { cat "$page"; echo "<script>"; cat "$work/driver.js"; echo "</script>"; } >"$work/driven.html"
  opened "file://$work/driven.html" >"$work/dom"
  if grep CONSOLE "$work/err"; then echo "$name: a message on the console"; bad=1; fi
  grep -q 'data-problems="none"' "$work/dom" ||
    { echo "$name: $(grep -o 'data-problems="[^"]*"' "$work/dom" || echo "the script did not end")"; bad=1; }
  rm "$page" "$work/driven.html"
done
[ $bad = 0 ] && echo "pages work in $("$chromium" --version)"
exit $bad
