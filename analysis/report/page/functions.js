// SPDX-License-Identifier: MIT
// The table of functions for the range: those with most time in the whole run, from sums of columns
// of time. Cells are written as report/html_table.cpp writes them.
(function () {
  var table = hasTime && byId("functions-table"), series = data.functions;
  if (!table) return;
  if (!series) return watchers.push(function () { if (isWhole()) setNote(table, null); else saysWhole(table); });
  var functions = series.list.map(function (f) {
    return {estimated: f.estimated, calls: sumsOf(numbersOf(f.calls)), inclusive: stepSums(f.inclusive), exclusive: stepSums(f.exclusive)};
  });
  var total = stepSums(series.all), isNode = data.names.map(function (name) { return name !== "host"; }), hasSpread = table.tHead.rows[0].cells.length > 6;
  if (series.byRank) series.byRank.forEach(function (f, i) {
    functions[i].byRank = f.rows.map(function (row) {
      var sums = sumsOf(unpackBits(row, series.rankColumns));
      for (var k = 0; k < sums.length; ++k) sums[k] *= f.unit;
      return sums;
    });
  });
  var lines = Array.from(table.tBodies[0].rows, function (row) {
    var cells = Array.from(row.cells).slice(2);
    return {row: row, of: functions[row.dataset.f], cells: cells, whole: cells.map(function (cell) { return [cell.innerHTML, cell.dataset.v, cell.className]; })};
  });
  function set(cell, value, words) {
    cell.textContent = words;
    cell.dataset.v = value;
  }
  function setTime(cell, ns, about) { set(cell, (ns * 1e-9).toPrecision(9), (about ? "\u2248 " : "") + formatSeconds(ns * 1e-9)); }
  function within(sums, columns) { return sumBetween(sums, (range.from - data.begin) / span * columns, (range.to - data.begin) / span * columns); }
  function spark(cell, seconds) {
    var bars = Math.min(seconds.length, 48), values = [], counts = [], largest = 0, pitch = Math.floor(Math.min(10, 96 / bars)), d = "";
    for (var i = 0; i < bars; ++i) values[i] = counts[i] = 0;
    seconds.forEach(function (time, rank) { var bar = Math.floor(rank * bars / seconds.length); values[bar] += time; ++counts[bar]; });
    values = values.map(function (value, bar) { return value / counts[bar]; });
    largest = Math.max.apply(null, values);
    if (largest > 0) values.forEach(function (value, bar) {
      var height = Math.round(value / largest * 18), width = Math.max(1, pitch - 1);
      if (height > 0) d += "M" + bar * pitch + " 18h" + width + "v-" + height + "h-" + width + "z";
    });
    cell.className = "spark";
    cell.textContent = "";
    var svg = cell.appendChild(makeSvg("svg", {viewBox: "0 0 96 18", width: 96, height: 18, "aria-hidden": "true"}));
    path(svg, d, {});
  }
  function setSpread(cells, f) {
    if (!f.byRank) return cells.slice(0, 5).forEach(function (cell) { cell.className = "n"; set(cell, "", "\u2013"); });
    var times = f.byRank.map(function (sums) { return within(sums, series.rankColumns); });
    var some = times.filter(function (time, rank) { return isNode[rank]; }), sum = some.reduce(function (a, b) { return a + b; }, 0), mean = sum / some.length;
    var most = Math.max.apply(null, some), ratio = mean > 0 ? most / mean : 0;
    if (mean > 0) [Math.min.apply(null, some), mean, most].forEach(function (time, i) { setTime(cells[i], time, f.estimated); });
    else cells.slice(0, 3).forEach(function (cell) { set(cell, "", ""); });
    cells[3].className = ratio >= 1.25 ? "n uneven" : "n";
    set(cells[3], mean > 0 ? ratio.toPrecision(4) : "", mean > 0 ? ratio.toFixed(2) : "");
    spark(cells[4], times);
  }
  function setShare(cell, inclusive, exclusive, all, largest) {
    function width(value) { return (largest > 0 ? clamp(value / largest, 0, 1) * 100 : 0).toFixed(1) + "%"; }
    var line = make("span"), bars = line.appendChild(make("i", {"aria-hidden": "true"}));
    if (inclusive > 0) [inclusive, exclusive].forEach(function (time) { bars.appendChild(make("b")).style.width = width(time); });
    line.append(formatPercent(all > 0 ? exclusive / all : 0));
    cell.replaceChildren(line);
  }
  watchers.push(function () {
    if (isWhole()) {
      lines.forEach(function (line) {
        line.row.hidden = false;
        line.cells.forEach(function (cell, i) {
          cell.innerHTML = line.whole[i][0];
          cell.className = line.whole[i][2];
          if (line.whole[i][1] === undefined) delete cell.dataset.v;
          else cell.dataset.v = line.whole[i][1];
        });
      });
      setNote(table, null);
    } else {
      var all = within(total, series.columns), largest = 0;
      lines.forEach(function (line) { if (line.of) largest = Math.max(largest, within(line.of.inclusive, series.columns)); });
      lines.forEach(function (line) {
        var f = line.of, cells = line.cells;
        if (!f) return cells.forEach(function (cell) { set(cell, "", "\u2013"); });
        var calls = Math.round(within(f.calls, series.columns)), inclusive = within(f.inclusive, series.columns), exclusive = within(f.exclusive, series.columns);
        line.row.hidden = !(calls > 0 || inclusive > 0);
        set(cells[0], calls, (f.estimated ? "\u2248 " : "") + formatCount(calls));
        setTime(cells[1], inclusive, f.estimated);
        setTime(cells[2], exclusive, f.estimated);
        setShare(cells[3], inclusive, exclusive, all, largest);
        if (hasSpread) setSpread(cells.slice(4), f);
      });
      setNote(table, formatRange(range.from, range.to) + ", summed over all ranks, in steps of " + formatSeconds(span / series.columns) + " \u00b7 of the " + functions.length + " with most time in the whole run" +
        (hasSpread && !series.byRank ? " \u00b7 by rank: whole run only" : ""));
    }
    table.sortAgain();
  });
})();
