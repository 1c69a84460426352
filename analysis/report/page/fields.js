// SPDX-License-Identifier: MIT
// Pictures of all ranks for the range: Kiviat, contour and context switches, drawn as their views do
// (views/kiviat_view.cpp, contour_view.cpp, strip_view.cpp).

// Neighbouring rows of the timeline as one, until at most so many are left; the host stays alone.
function groupedRows(most) {
  var alone = nodes.length < rows.length ? rows.length - nodes.length : 0, each = 1, groups = [];
  while (Math.ceil((rows.length - alone) / each) + alone > most) each *= 2;
  rows.forEach(function (row, i) {
    if (row.host || i % each === 0 || rows[i - 1].host) groups.push([]);
    groups[groups.length - 1].push(row);
  });
  return groups;
}
function meanShare(group, from, to) {
  var sum = 0, ranks = 0;
  group.forEach(function (row) { sum += row.n * row.seconds(from, to)[0]; ranks += row.n; });
  return clamp(sum / ranks / (to - from), 0, 1);
}

panelOf("kiviat", function (svg) {
  var layer = liveLayer(svg, ["grid", "labels", "letters"]), groups = groupedRows(128), radius = 220;
  function at(share, i) {
    var turn = 2 * Math.PI * i / groups.length;
    return (340 + radius * share * Math.sin(turn)).toFixed(1) + " " + (280 - radius * share * Math.cos(turn)).toFixed(1);
  }
  var points = groups.map(function (group, i) { return at(meanShare(group, range.from, range.to), i); });
  if (groups.length > 2) path(layer, "M" + points.join("L") + "z", {fill: colour.band});
  path(layer, "M" + points.join("L") + (groups.length > 1 ? "z" : "L340 280"), {stroke: colour.states[0], "stroke-width": 2});
  if (groups.length <= 40) points.forEach(function (point) {
    var xy = point.split(" ");
    layer.appendChild(makeSvg("circle", {cx: xy[0], cy: xy[1], r: 3, fill: colour.states[0]}));
  });
  setNote(svg, "utilisation, " + formatRange(range.from, range.to));
});

// Evenly between the middles of neighbouring rows; a level is all that is at least as much.
panelOf("contour", function (svg) {
  var groups = groupedRows(64), area = rectanglesOf(svg, "cells")[0], moments = clamp(Math.floor(16000 / groups.length), 60, 240);
  var layer = liveLayer(svg, ["labels"]), step = (range.to - range.from) / moments, cells = layer.appendChild(makeSvg("g", {"class": "cells"}));
  var values = groups.map(function (group) {
    var line = [];
    for (var i = 0; i < moments; ++i) line.push(meanShare(group, range.from + i * step, range.from + (i + 1) * step));
    return line;
  });
  var tall = area.height / groups.length, middles = groups.map(function (group, i) { return area.y + (i + .5) * tall; });
  var labels = all(":scope > g.labels text", svg).map(function (label) { return label.getAttribute("y") - .364 * (label.getAttribute("font-size") || 12); });
  if (labels.length === groups.length) middles = labels;
  values = [values[0]].concat(values, [values[values.length - 1]]);
  middles = [area.y].concat(middles, [area.y + area.height]);
  function x(i) { return (area.x + (i + .5) / moments * area.width).toFixed(1); }
  function stretch(level, upper, lower) {
    if (upper >= level && lower >= level) return [0, 1];
    if (upper < level && lower < level) return null;
    var cross = (upper - level) / (upper - lower);
    return upper >= level ? [0, cross] : [cross, 1];
  }
  rectangle(cells, area.x, area.y, area.width, area.height, "#fefefe");
  [1, 2, 3, 4].forEach(function (k) {
    var d = "";
    for (var r = 0; r + 1 < values.length; ++r) {
      var run = [], first = 0, top = Math.round(middles[r]), height = Math.round(middles[r + 1]) - top;
      for (var i = 0; i <= moments; ++i) {
        var next = i < moments ? stretch(k / 5, values[r][i], values[r + 1][i]) : null, last = run[run.length - 1];
        if (last && !(next && next[0] < last[1] && last[0] < next[1])) {
          if (run.length === 1) run.push(last);
          var end = first + run.length - 1;
          d += "M" + run.map(function (s, n) { return x(first + n) + " " + (top + s[0] * height).toFixed(1); })
            .concat(run.map(function (s, n) { return x(end - n) + " " + (top + run[run.length - 1 - n][1] * height).toFixed(1); })).join("L") + "z";
          run = [];
        }
        if (next) { if (!run.length) first = i; run.push(next); }
      }
    }
    path(cells, d, {fill: rampColour(k * rampSteps / 4)});
  });
  drawAxisOf(layer, area.x, area.x + area.width, area.y + area.height + 6);
  setNote(svg, "utilisation, " + formatRange(range.from, range.to));
});

panelOf("switches", function (svg) {
  var series = data.switches, grounds = rectanglesOf(svg, "grid");
  if (!series || series.rows.length !== grounds.length) return saysWhole(svg);
  var layer = liveLayer(svg, ["grid", "labels"]), bands = layer.appendChild(makeSvg("g", {"class": "band"})), width = grounds[0].width, parts = 250;
  var count = numbersOf(series.rows[0].n).length, step = (series.end - data.begin) / count, largest = 0;
  var lines = series.rows.map(function (row) {
    var sums = row.sums = row.sums || sumsOf(numbersOf(row.n)), line = [];
    for (var i = 0; i < parts; ++i) {
      var from = range.from + (range.to - range.from) * i / parts, to = from + (range.to - range.from) / parts;
      line.push(sumBetween(sums, (from - data.begin) / step, (to - data.begin) / step) / row.ranks / (to - from));
    }
    largest = Math.max(largest, Math.max.apply(null, line));
    return line;
  });
  largest = roundStep(Math.max(largest, 1e-9), 1);
  lines.forEach(function (line, r) {
    var ground = grounds[r], bottom = ground.y + ground.height, d = "M" + ground.x + " " + bottom;
    line.forEach(function (rate, i) { d += "V" + (bottom - rate / largest * ground.height).toFixed(2) + "H" + (ground.x + (i + 1) / parts * width).toFixed(2); });
    path(bands, d + "V" + bottom + "z", {fill: colour.states[0]});
  });
  drawAxisOf(layer, grounds[0].x, grounds[0].x + width, grounds[grounds.length - 1].y + grounds[0].height + 6);
  setNote(svg, "each row 0\u2013" + formatShort(largest) + " /s, " + formatRange(range.from, range.to) + " \u00b7 in steps of " + formatSeconds(step));
});

// What is not followed says so.
["sizes", "types", "callpaths"].forEach(function (name) {
  panelOf(name, saysWhole);
});
