// SPDX-License-Identifier: MIT
// Matrices of the range, laid out as views/matrix_view.cpp does. Where the messages were too many to
// be embedded, the matrices go on showing the whole run and say so.
(function () {
  if (!hasTime) return;
  var ramp = [[0xee, 0xf4, 0xfa], [0x9d, 0xc1, 0xe2], [0x36, 0x72, 0xb9], [0x08, 0x28, 0x56]], steps = 24;
  function rampColour(step) {
    var scaled = clamp(step / steps, 0, 1) * 3, stop = Math.min(2, Math.floor(scaled)), share = scaled - stop;
    return "#" + [0, 1, 2].map(function (i) { return ("0" + Math.round(ramp[stop][i] + (ramp[stop + 1][i] - ramp[stop][i]) * share).toString(16)).slice(-2); }).join("");
  }
  function stepOf(value, largest) { return value > 0 && largest > 0 ? clamp(Math.round(Math.sqrt(value / largest) * steps), 1, steps) : 0; }
  // Every place of the label texts of the drawn matrix tells where a row lies.
  function placesOf(svg, count) {
    var texts = all(":scope > g.labels text", svg).filter(function (label) { return label.getAttribute("text-anchor") === "end" && +label.getAttribute("y") > 24; });
    if (texts.length !== count) return null;
    return texts.map(function (label) { return +label.getAttribute("y") - 12 * .364; });
  }
  function draw(svg, valueOf, isBytes) {
    var count = data.names.length, middles = placesOf(svg, count);
    if (!messages.list || !middles) return setNote(svg, "whole run \u00b7 " + (svg.closest("section.panel").querySelector(".note").dataset.whole || ""));
    var values = data.names.map(function () { return new Float64Array(count); }), largest = 0;
    messages.list.forEach(function (message) {
      if (message.time < range.from || message.time > range.to) return;
      largest = Math.max(largest, values[message.from][message.to] += valueOf(message));
    });
    var layer = liveLayer(svg, ["labels", "words"]), left = +svg.dataset.left, shift = left - 24;
    var cell = count > 1 ? middles[1] - middles[0] : 44, drawn = cell - (cell >= 6 ? 1 : 0), unit = isBytes ? byteUnit(largest) : ["count", 1];
    function back(from, to) {
      return [middles[from] - drawn / 2 - 1, middles[to] - middles[from] + drawn + 2];
    }
    var numbers = [], host = count > 1 && data.names[count - 1] === "host" ? count - 1 : count, blocks = [back(0, host - 1)];
    if (host < count) blocks.push(back(host, host));
    blocks.forEach(function (y) { blocks.forEach(function (x) { rectangle(layer, x[0] + shift, y[0], x[1], y[1], colour.grid); }); });
    var cells = layer.appendChild(makeSvg("g", {"class": "cells"}));
    values.forEach(function (line, i) {
      line.forEach(function (value, k) {
        var step = stepOf(value, largest), x = middles[k] + shift - drawn / 2, y = middles[i] - drawn / 2;
        rectangle(cells, x, y.toFixed(2), drawn, drawn, step ? rampColour(step) : "#fefefe",
          step ? data.names[i] + " \u2192 " + data.names[k] + ": " + (isBytes ? formatBytes(value) : formatCount(value) + (value === 1 ? " message" : " messages")) : "");
        if (step) numbers.push([middles[k] + shift, middles[i], formatShort(value / unit[1]), step]);
      });
    });
    var size = clamp(Math.floor(cell * .4), 9, 12), widest = Math.max.apply(null, numbers.map(function (n) { return textWidth(n[2], size); }).concat(0));
    if (cell >= 16 && widest + 3 <= cell) numbers.forEach(function (n) {
      text(layer, n[0], n[1], n[2], {size: size, anchor: "middle", fill: n[3] >= 14 ? "#fffffe" : "#1f2934"});
    });
    setNote(svg, unit[0] + ", sent in " + formatRange(range.from, range.to));
  }
  function leftOf(svg) {
    var cells = svg.querySelector(":scope > g.cells path"), start = cells && /M([\d.-]+)/.exec(cells.getAttribute("d"));
    return start ? +start[1] + 1 : 0;
  }
  function one() { return 1; }
  function bytes(message) { return message.bytes; }
  [["matrix", one, false], ["matrix-count", one, false], ["volume", bytes, true], ["matrix-bytes", bytes, true]].forEach(function (kind) {
    panelOf(kind[0], function (svg) {
      if (!svg.dataset.left) svg.dataset.left = leftOf(svg);
      draw(svg, kind[1], kind[2]);
    });
  });
})();
