// SPDX-License-Identifier: MIT
// The time axis that panels share, and the line through all of them at the moment under the pointer.
function roundStep(length, count) {
  var raw = length / count, power = Math.pow(10, Math.floor(Math.log10(raw)));
  return power * (raw <= power * 1.0001 ? 1 : raw <= power * 2.0001 ? 2 : raw <= power * 5.0001 ? 5 : 10);
}
function xOf(time) { return data.left + (time - range.from) / (range.to - range.from) * (data.right - data.left); }
function timeOf(x) { return range.from + (x - data.left) / (data.right - data.left) * (range.to - range.from); }
// Ticks at round times; where the range is tiny beside its start they count from the first of them.
function timeTicks() {
  var length = range.to - range.from, unit = timeUnit(Math.max(Math.abs(range.to), 1e-9)), step = roundStep(length / unit[1], 10);
  var first = Math.ceil(range.from / unit[1] / step - 1e-9), last = Math.floor(range.to / unit[1] / step + 1e-9), ticks = [];
  var digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  for (var i = first; i <= last && ticks.length < 20; ++i) ticks.push({x: xOf(i * step * unit[1]), label: (i * step).toFixed(digits)});
  while (ticks.length > 2 && ticks[1].x - ticks[0].x < textWidth(ticks[ticks.length - 1].label, 12) + 14)
    ticks = ticks.filter(function (tick, k) { return k % 2 === 0; });
  if (ticks.length) ticks[ticks.length - 1].label += " " + unit[0];
  return ticks;
}
function drawAxis(layer, y) { drawAxisOf(layer, data.left, data.right, y); }
// Of a picture whose axis lies elsewhere.
function drawAxisOf(layer, left, right, y) {
  var ticks = timeTicks(), d = "M" + left + " " + (Math.floor(y) + .5) + "H" + right, scale = (right - left) / (data.right - data.left);
  ticks.forEach(function (tick) { tick.x = left + (tick.x - data.left) * scale; });
  ticks.forEach(function (tick) { d += "M" + (Math.floor(tick.x) + .5) + " " + (Math.floor(y) + .5) + "v5"; });
  path(layer, d, {stroke: colour.hairline});
  ticks.forEach(function (tick) {
    var half = textWidth(tick.label, 12) / 2, x = Math.min(tick.x, right + 14 - half);
    text(layer, x, y + 16, tick.label, {fill: colour.secondary, anchor: "middle"});
  });
}

// Pictures over the whole width of the timeline; each has its own line for the moment.
var timePanels = hasTime ? all("svg[class]").filter(function (svg) {
  return ["view-timeline", "view-utilisation", "view-message-load"].indexOf(svg.getAttribute("class").split(" ")[0]) >= 0;
}).map(function (svg) {
  var line = makeSvg("path", {"class": "cursor"});
  svg.appendChild(line);
  return {svg: svg, line: line, bottom: svg.viewBox.baseVal.height - (svg.querySelector(".axis") ? 26 : 8)};
}) : [];
momentWatchers.push(function () {
  var shown = moment !== null && moment >= range.from && moment <= range.to;
  timePanels.forEach(function (panel) {
    if (shown) panel.line.setAttribute("d", "M" + xOf(moment).toFixed(1) + " 0V" + panel.bottom);
    else panel.line.removeAttribute("d");
  });
});
