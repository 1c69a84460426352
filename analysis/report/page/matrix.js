// SPDX-License-Identifier: MIT
// Matrices of the range, laid out as views/matrix_view.cpp does. Of few messages each is known; of
// many, and of waits, sums of columns of time, the coarser the more pairs of ranks there are.
(function () {
  if (!hasTime) return;
  var deep = 14, cells = data.cells || {each: 1, count: data.names.length}, ranks = data.names.length, host = ranks > 1 && data.names[ranks - 1] === "host";
  var names = [];
  function cellOf(rank) { return host && rank + 1 === ranks ? cells.count - 1 : Math.floor(rank / cells.each); }
  data.names.forEach(function (name, rank) { if (!(cellOf(rank) in names)) names[cellOf(rank)] = name; });
  function stepOf(value, largest) { return value > 0 && largest > 0 ? clamp(Math.round(Math.sqrt(value / largest) * rampSteps), 1, rampSteps) : 0; }

  // By column of time: pairs and their values, one after the other.
  function columnsOf(series, width) {
    if (!series) return null;
    var numbers = numbersOf(series.n), columns = [], i = 0;
    while (i < numbers.length) {
      var count = numbers[i++], column = [], pair = 0;
      for (; count > 0; --count) {
        column.push(pair += numbers[i++]);
        for (var k = 0; k < width; ++k) column.push(numbers[i++]);
      }
      columns.push(column);
    }
    return {columns: columns, width: width};
  }
  var waiting = columnsOf(data.pairWaits, 1), sent = columnsOf(data.pairMessages, 2);
  function sumsIn(series) {
    var sums = [], count = series.columns.length, a = (range.from - data.begin) / span * count, b = (range.to - data.begin) / span * count;
    for (var k = 0; k < series.width; ++k) sums.push(new Float64Array(cells.count * cells.count));
    for (var c = Math.max(0, Math.floor(a)); c < Math.min(count, b); ++c) {
      var column = series.columns[c], share = Math.min(b, c + 1) - Math.max(a, c);
      for (var i = 0; i < column.length; i += series.width + 1)
        for (k = 0; k < series.width; ++k) sums[k][column[i]] += column[i + 1 + k] * share;
    }
    return sums;
  }
  function messagesIn() {
    if (!messages.list) return sent && sumsIn(sent);
    var sums = [new Float64Array(cells.count * cells.count), new Float64Array(cells.count * cells.count)];
    messages.list.forEach(function (message) {
      if (message.time < range.from || message.time > range.to) return;
      var pair = cellOf(message.from) * cells.count + cellOf(message.to);
      ++sums[0][pair];
      sums[1][pair] += message.bytes;
    });
    return sums;
  }

  function layoutOf(svg) {
    if (!svg.dataset.left) svg.dataset.left = rectanglesOf(svg, "cells")[0].x + 1;
    var left = +svg.dataset.left, cell = Math.max(1, Math.floor(Math.min(44, (330 - left - 4) / cells.count)));
    return {left: left, top: 24, cell: cell, drawn: cell - (cell >= 6 ? 1 : 0),
      at: function (i) { return i * cell + (host && i === cells.count - 1 ? 4 : 0); }};
  }
  function drawGround(layer, layout) {
    var inner = host ? cells.count - 1 : cells.count, gap = layout.cell - layout.drawn, blocks = [[0, inner * layout.cell]];
    if (host) blocks.push([layout.at(inner), layout.cell]);
    blocks.forEach(function (y) { blocks.forEach(function (x) { rectangle(layer, layout.left + x[0] - 1, layout.top + y[0] - 1, x[1] + 2 - gap, y[1] + 2 - gap, colour.grid); }); });
  }
  function drawCells(layer, layout, values, largest, kind) {
    var group = layer.appendChild(makeSvg("g", {"class": "cells"})), paths = {}, told = cells.count <= 33;
    values.forEach(function (value, pair) {
      var i = Math.floor(pair / cells.count), k = pair % cells.count, step = stepOf(value, largest), x = layout.left + layout.at(k), y = layout.top + layout.at(i);
      var fill = step ? rampColour(step) : "#fefefe";
      if (told && step) rectangle(group, x, y, layout.drawn, layout.drawn, fill, names[i] + " \u2192 " + names[k] + ": " + kind.text(value));
      else paths[fill] = (paths[fill] || "") + "M" + x + " " + y + "h" + layout.drawn + "v" + layout.drawn + "h-" + layout.drawn + "z";
    });
    for (var fill in paths) path(group, paths[fill], {fill: fill});
  }
  function drawNumbers(layer, layout, values, largest, unit) {
    var size = clamp(Math.floor(layout.cell * .4), 9, 12), numbers = [], widest = 0, half = layout.drawn / 2;
    values.forEach(function (value, pair) {
      if (!(value > 0)) return;
      var words = formatShort(value / unit);
      widest = Math.max(widest, textWidth(words, size));
      numbers.push([layout.left + layout.at(pair % cells.count) + half, layout.top + layout.at(Math.floor(pair / cells.count)) + half, words, stepOf(value, largest)]);
    });
    while (size > 9 && widest + 4 > layout.cell) { widest *= (size - 1) / size; --size; }
    if (layout.cell < 16 || widest + 3 > layout.cell) return false;
    numbers.forEach(function (n) { text(layer, n[0], n[1], n[2], {size: size, anchor: "middle", fill: n[3] >= deep ? "#fffffe" : "#1f2934"}); });
    return true;
  }
  function draw(svg, kind) {
    var values = kind.values();
    if (!values) return saysWhole(svg);
    var layer = liveLayer(svg, ["labels", "words"]), layout = layoutOf(svg), largest = values.reduce(function (a, b) { return Math.max(a, b); }, 0), unit = kind.unit(largest);
    drawGround(layer, layout);
    drawCells(layer, layout, values, largest, kind);
    var numbers = drawNumbers(layer, layout, values, largest, unit[1]), columns = kind.columns();
    setNote(svg, (numbers ? unit[0] : "at most " + kind.text(largest)) + ", " + formatRange(range.from, range.to) + (columns ? " \u00b7 in steps of " + formatSeconds(span / columns) : "") +
      (cells.each > 1 ? " \u00b7 cell: " + cells.each + " \u00d7 " + cells.each + " ranks" : ""));
  }
  function columnsSent() { return messages.list ? 0 : sent.columns.length; }
  function one(which) { return function () { var sums = messagesIn(); return sums && sums[which]; }; }
  var counts = {values: one(0), columns: columnsSent, unit: function () { return ["count", 1]; },
    text: function (value) { return formatCount(value) + (Math.round(value) === 1 ? " message" : " messages"); }};
  var bytes = {values: one(1), columns: columnsSent, unit: byteUnit, text: formatBytes};
  var means = {columns: columnsSent, unit: byteUnit, text: formatBytes, values: function () {
    var sums = messagesIn();
    return sums && sums[1].map(function (sum, pair) { return sums[0][pair] > 0 ? sum / sums[0][pair] : 0; });
  }};
  var waits = {columns: function () { return waiting.columns.length; }, unit: timeUnit, text: formatSeconds, values: function () {
    return waiting && sumsIn(waiting)[0].map(function (microseconds) { return microseconds * 1e-6; });
  }};
  [["matrix", counts], ["matrix-count", counts], ["volume", bytes], ["matrix-bytes", bytes], ["matrix-mean", means], ["matrix-wait", waits]].forEach(function (pair) {
    panelOf(pair[0], function (svg) { draw(svg, pair[1]); });
  });
})();
