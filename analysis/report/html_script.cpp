// SPDX-License-Identifier: MIT
// The page's script. It adds; nothing is lost without it.
#include "analysis/report/html_style.h"

namespace stipple {
namespace {

constexpr std::string_view kScript = R"js(
(function () {
  "use strict";
  // Tables: a click on a column's name sorts by it.
  document.querySelectorAll("table.sortable").forEach(function (table) {
    table.querySelectorAll("thead th").forEach(function (head, column) {
      if (!head.dataset.sort) return;
      var button = document.createElement("button");
      button.type = "button";
      button.textContent = head.textContent;
      head.textContent = "";
      head.appendChild(button);
      button.addEventListener("click", function () {
        var down = head.getAttribute("aria-sort") !== "descending";
        if (head.dataset.sort === "text") down = head.getAttribute("aria-sort") === "ascending";
        table.querySelectorAll("th[aria-sort]").forEach(function (other) { other.removeAttribute("aria-sort"); });
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        var body = table.tBodies[0], rows = Array.from(body.rows);
        var value = function (row) { var cell = row.cells[column]; return "v" in cell.dataset ? cell.dataset.v : cell.textContent; };
        rows.sort(function (a, b) {
          var one = value(a), other = value(b);
          if (one === "" || other === "") return (one === "") - (other === "");  // unknown comes last
          var order = head.dataset.sort === "text" ? one.localeCompare(other, "en", {numeric: true}) : one - other;
          return down ? -order : order;
        });
        rows.forEach(function (row) { body.appendChild(row); });
      });
    });
  });

  // Timeline: shares under the pointer, and a line through all panels of the same time axis.
  var source = document.getElementById("hover"), svg = document.querySelector("svg.view-timeline");
  if (!source || !svg) return;
  var data = JSON.parse(source.textContent), letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  if (!data.rows) return;
  var columns = data.rows[0][3].length / 3, figure = svg.parentNode, tip = document.createElement("div");
  tip.id = "tip"; tip.hidden = true; tip.setAttribute("role", "status");
  figure.appendChild(tip);
  var lines = Array.from(document.querySelectorAll(".main svg")).map(function (panel) {
    var line = document.createElementNS(svg.namespaceURI, "path");
    line.setAttribute("class", "cursor");
    panel.appendChild(line);
    return [panel, line];
  });
  function seconds(value) {
    var span = data.end - data.begin, unit = span >= 1 ? ["s", 1] : span >= 1e-3 ? ["ms", 1e3] : ["\u00b5s", 1e6];
    return (value * unit[1]).toFixed(Math.max(0, 3 - Math.floor(Math.log10(span * unit[1] || 1)))) + " " + unit[0];
  }
  function share(row, column, state) { return letters.indexOf(data.rows[row][3][column * 3 + state]) / 63; }
  function line(label, value) { return "<br>" + label + " " + Math.round(value * 100) + "%"; }
  var at = {row: 0, column: 0};
  function show(row, column) {
    at = {row: row, column: column};
    var step = (data.end - data.begin) / columns, from = data.begin + column * step;
    var user = share(row, column, 0), system = share(row, column, 1), message = share(row, column, 2);
    tip.innerHTML = "<b>" + data.rows[row][0].replace(/&/g, "&amp;").replace(/</g, "&lt;") + "</b>" + seconds(from) + " \u2013 " + seconds(from + step) +
      line("user computation", user) + line("system", system) + line("message transmission", message) +
      line("idle", Math.max(0, 1 - user - system - message));
    tip.hidden = false;
    var x = data.left + (column + .5) / columns * (data.right - data.left), box = svg.viewBox.baseVal;
    var scale = svg.getBoundingClientRect().width / box.width, y = data.rows[row][1] + data.rows[row][2];
    var left = x * scale + 14;
    if (left + tip.offsetWidth > figure.clientWidth) left = x * scale - tip.offsetWidth - 14;
    tip.style.left = left + "px";
    tip.style.top = y * scale + 6 + "px";
    lines.forEach(function (pair) { pair[1].setAttribute("d", "M" + x + " 0V" + (pair[0].viewBox.baseVal.height - (pair[0].querySelector(".axis") ? 26 : 8))); });
  }
  function hide() {
    tip.hidden = true;
    lines.forEach(function (pair) { pair[1].removeAttribute("d"); });
  }
  svg.addEventListener("pointermove", function (event) {
    var area = svg.getBoundingClientRect(), scale = svg.viewBox.baseVal.width / area.width;
    var x = (event.clientX - area.left) * scale, y = (event.clientY - area.top) * scale;
    if (x < data.left || x > data.right) return hide();
    var row = 0, away = data.rows.map(function (r) { return Math.abs(y - r[1] - r[2] / 2) - r[2] / 2; });
    away.forEach(function (pixels, i) { if (pixels < away[row]) row = i; });
    if (away[row] > 6) return hide();
    show(row, Math.min(columns - 1, Math.floor((x - data.left) / (data.right - data.left) * columns)));
  });
  svg.addEventListener("pointerleave", hide);
  figure.tabIndex = 0;
  figure.setAttribute("aria-label", "Timeline: arrow keys, Home and End read the shares of each column");
  figure.addEventListener("focus", function () { if (figure.matches(":focus-visible")) show(at.row, at.column); });
  figure.addEventListener("blur", hide);
  figure.addEventListener("keydown", function (event) {
    var move = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0], Home: [0, -columns], End: [0, columns]}[event.key];
    if (event.key === "Escape") hide();
    if (!move) return;
    event.preventDefault();
    show(Math.min(data.rows.length - 1, Math.max(0, at.row + move[0])), Math.min(columns - 1, Math.max(0, at.column + move[1])));
  });
})();
)js";

}  // namespace

std::string_view PageScript() { return kScript; }

}  // namespace stipple
