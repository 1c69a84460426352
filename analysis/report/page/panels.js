// SPDX-License-Identifier: MIT
// Panels that show the range: bars, utilisation, message load, who was waited for, and the tables.
// Each draws as its view does (views/bars_view.cpp, load_view.cpp), into a layer of its own.
function panelOf(name, update) {
  var svg = hasTime && document.querySelector("svg.view-" + name);
  if (!svg) return;
  var heading = svg.closest("section.panel").querySelector("h3"), title = heading.textContent;
  watchers.push(function () {
    heading.textContent = isWhole() ? title : title.replace("Whole run", "This part").replace("whole run", "this part");
    if (isWhole()) setNote(svg, null);
    else update(svg);
  });
}
var messages = data.messages || {count: 0};
if (messages.all) (function () {
  var numbers = numbersOf(messages.all), last = 0;
  messages.list = [];
  for (var i = 0; i + 3 < numbers.length; i += 4) {
    last += numbers[i];
    messages.list.push({time: data.begin + last / 1073741824 * span, from: numbers[i + 1], to: numbers[i + 2], bytes: numbers[i + 3]});
  }
})();
if (messages.counts) { messages.countSums = sumsOf(numbersOf(messages.counts)); messages.byteSums = sumsOf(numbersOf(messages.bytes)); }
// Messages and bytes sent before a time.
function sentBefore(time) {
  var place = (time - data.begin) / span * messages.bins;
  return [sumTo(messages.countSums, place), sumTo(messages.byteSums, place)];
}

panelOf("bars", function (svg) {
  var layer = liveLayer(svg, []), length = range.to - range.from, width = 300, sum = 0, most = 0;
  var bars = layer.appendChild(makeSvg("g", {"class": "bars"}));
  rows.forEach(function (row) {
    var time = row.seconds(range.from, range.to), x = 0;
    time.forEach(function (seconds, s) {
      rectangle(bars, x, row.y, seconds / length * width, row.h, colour.states[s]);
      x += seconds / length * width;
    });
    if (row.label) text(layer, 360, row.y + row.h / 2, formatPercent(time[0] / length), {size: 13, anchor: "end"});
  });
  nodes.forEach(function (row) { var time = row.seconds(range.from, range.to)[0]; sum += time / nodes.length; most = Math.max(most, time); });
  if (rows.length > 1) {
    var top = rows[0].y, bottom = rows[rows.length - 1].y + rows[rows.length - 1].h, x = Math.floor(sum / length * width) + .5;
    var mean = "mean " + formatPercent(sum / length), half = textWidth(mean, 12) / 2, middle = Math.max(x, half);
    path(layer, "M" + x + " " + (top - 4) + "V" + (bottom + 8), {stroke: colour.ink, "stroke-dasharray": "3 3"});
    text(layer, middle, bottom + 18, mean, {anchor: "middle"});
    var words = "busiest " + (sum > 0 ? (most / sum).toFixed(2) : "1.00") + " \u00d7 mean", left = middle + half + 12 > 360 - textWidth(words, 12);
    text(layer, left ? 0 : 360, bottom + 18, words, {fill: colour.secondary, anchor: left ? "start" : "end"});
  }
  setNote(svg, "share computing");
});

// Curves.
var curveTop = 8, curveHeight = 92, curveColumns = 512;
function windowOf() { return roundStep(range.to - range.from, 40); }
function formatWindow(seconds) { var unit = timeUnit(range.to - range.from); return +(seconds / unit[1]).toPrecision(3) + " " + unit[0]; }
function curve(values, largest) {
  var step = (data.right - data.left) / values.length;
  return values.map(function (value, i) {
    var x = i === 0 ? data.left : i + 1 === values.length ? data.right : data.left + (i + .5) * step;
    return x.toFixed(1) + " " + (curveTop + curveHeight * (1 - clamp(value / largest, 0, 1))).toFixed(1);
  });
}
function drawGrid(layer, labels) {
  labels.forEach(function (label, i) {
    var y = Math.floor(curveTop + curveHeight * (1 - i / 2)) + .5;
    path(layer, "M" + data.left + " " + y + "H" + data.right, {stroke: colour.grid});
    text(layer, data.left - 10, y, label, {fill: colour.secondary, anchor: "end"});
  });
}
function overTime(value) {
  var values = [], width = windowOf();
  for (var i = 0; i < curveColumns; ++i) {
    var time = range.from + (i + .5) / curveColumns * (range.to - range.from);
    values.push(value(Math.max(data.begin, time - width / 2), Math.min(data.end, time + width / 2), time));
  }
  return values;
}
panelOf("utilisation", function (svg) {
  var layer = liveLayer(svg, []), low = [], high = [];
  var mean = overTime(function (from, to) {
    var least = 1, most = 0, sum = 0;
    nodes.forEach(function (row) {
      var share = row.seconds(from, to)[0] / (to - from);
      sum += share / nodes.length;
      least = Math.min(least, share);
      most = Math.max(most, share);
    });
    low.push(least);
    high.push(most);
    return sum;
  });
  var since = overTime(function (from, to, time) {
    var sum = 0;
    nodes.forEach(function (row) { sum += row.seconds(data.begin, time)[0] / (time - data.begin) / nodes.length; });
    return sum;
  });
  drawGrid(layer, ["0", "50%", "100%"]);
  path(layer, "M" + curve(high, 1).concat(curve(low, 1).reverse()).join("L") + "z", {fill: colour.band});
  path(layer, "M" + curve(since, 1).join("L"), {stroke: colour.ink, "stroke-dasharray": "3 3", fill: "none"});
  path(layer, "M" + curve(mean, 1).join("L"), {stroke: colour.states[0], "stroke-width": 1.75, fill: "none"});
  if (svg.querySelector(".axis")) drawAxis(layer, curveTop + curveHeight);
  setNote(svg, "mean of " + data.noun + "s, " + formatWindow(windowOf()) + " window \u00b7 band: least to most busy \u00b7 dashed: since the start");
});
panelOf("message-load", function (svg) {
  if (!messages.byteSums) return saysWhole(svg);
  var layer = liveLayer(svg, []);
  var load = overTime(function (from, to) { return (sentBefore(to)[1] - sentBefore(from)[1]) / (to - from); });
  var largest = roundStep(Math.max.apply(null, load.concat(1)), 1), unit = byteUnit(largest);
  drawGrid(layer, ["0", formatShort(largest / 2 / unit[1]), formatShort(largest / unit[1])]);
  path(layer, "M" + data.left + " " + (curveTop + curveHeight) + "L" + curve(load, largest).join("L") + "V" + (curveTop + curveHeight) + "z", {fill: colour.loadFill});
  path(layer, "M" + curve(load, largest).join("L"), {stroke: colour.loadLine, "stroke-width": 1.5, fill: "none"});
  drawAxis(layer, curveTop + curveHeight);
  setNote(svg, unit[0] + "/s, " + formatWindow(windowOf()) + " window");
});

// Who was waited for: sums of columns of time, those at the ends in part.
var waits = (data.waits || []).map(function (wait) {
  return {rank: wait.rank, name: wait.name, region: wait.region, sums: sumsOf(numbersOf(wait.ns))};
});
function waitedIn(wait, from, to) {
  var bins = wait.sums.length - 1;
  return (sumTo(wait.sums, (to - data.begin) / span * bins) - sumTo(wait.sums, (from - data.begin) / span * bins)) * 1e-9;
}
panelOf("waited-for", function (svg) {
  if (!waits.length) return saysWhole(svg);
  var layer = liveLayer(svg, []), bars = layer.appendChild(makeSvg("g", {"class": "bars"}));
  var some = waits.map(function (wait) { return {wait: wait, seconds: waitedIn(wait, range.from, range.to)}; });
  some.sort(function (a, b) { return b.seconds - a.seconds; });
  var largest = some[0].seconds, unit = timeUnit(largest || span);
  some = some.filter(function (one) { return one.seconds > largest / 1000; }).slice(0, 6);
  function label(wait) { return /^\d+$/.test(wait.name) ? data.noun + " " + wait.name : wait.name; }
  var left = Math.ceil(Math.max.apply(null, some.map(function (one) { return textWidth(label(one.wait), 13, true) + 12; }).concat(60)));
  if (!some.length) text(layer, 0, 12, "Nobody was waited for in this part.", {size: 13, fill: colour.secondary});
  some.forEach(function (one, i) {
    var y = i * 46 + 12, culprit = one.wait.rank === data.culprit;
    text(layer, left - 10, y, label(one.wait), {size: 13, bold: culprit, anchor: "end"});
    rectangle(bars, left, y - 9, Math.max(1, one.seconds / largest * (360 - 64 - left)), 18, culprit ? colour.accent : colour.quiet);
    text(layer, 360, y, threeDigits(one.seconds / unit[1]), {size: 13, bold: true, anchor: "end"});
  });
  setNote(svg, "others\u2019 waiting, " + unit[0]);
});

// States as numbers, a row for each rank.
(function () {
  var table = hasTime && byId("states-table");
  if (!table || table.tBodies[0].rows.length !== rows.length) return;
  var cells = rows.map(function (row, i) { return Array.from(table.tBodies[0].rows[i].cells).slice(1, 5); });
  var before = cells.map(function (line) { return line.map(function (cell) { return [cell.textContent, cell.dataset.v]; }); });
  watchers.push(function () {
    rows.forEach(function (row, i) {
      var time = row.seconds(range.from, range.to);
      cells[i].forEach(function (cell, s) {
        var unknown = before[i][s][1] === "-1";
        cell.textContent = isWhole() || unknown ? before[i][s][0] : formatSeconds(time[s]);
        cell.dataset.v = isWhole() || unknown ? before[i][s][1] : time[s].toPrecision(9);
      });
    });
  });
})();
