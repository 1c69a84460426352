// SPDX-License-Identifier: MIT
// The timeline: a canvas over the picture while a part of the run is shown, drawn pixel by pixel from
// sums, so that its cost follows the picture's size; zoom by drag, wheel, keys and buttons; values
// under the pointer or the arrow keys.
var timeline = hasTime && document.querySelector("svg.view-timeline");
if (timeline) (function () {
  var figure = timeline.parentNode, plot = make("div", {"class": "plot"}), canvas = make("canvas", {"aria-hidden": "true"});
  var glass = make("div", {"class": "glass"}), band = make("div", {"class": "band", hidden: ""}), tip = make("div", {id: "tip", role: "status", hidden: ""});
  var view = timeline.viewBox.baseVal, first = rows[0], last = rows[rows.length - 1], top = first.y, bottom = last.y + last.h;
  figure.insertBefore(plot, timeline);
  plot.append(timeline, canvas, glass, tip);
  glass.appendChild(band);
  [canvas, glass].forEach(function (part) {
    part.style.left = data.left / view.width * 100 + "%";
    part.style.width = (data.right - data.left) / view.width * 100 + "%";
    part.style.top = top / view.height * 100 + "%";
    part.style.height = (bottom - top) / view.height * 100 + "%";
  });
  plot.tabIndex = 0;
  plot.setAttribute("role", "group");
  plot.setAttribute("aria-label", "Timeline. Left and right arrows read the shares of each column, up and down another row; plus and minus zoom, with Shift arrows move, 0 shows the whole run");

  var dot = make("canvas", {width: 1, height: 1}).getContext("2d", {willReadFrequently: true});
  function packed(css) {
    dot.fillStyle = css;
    dot.fillRect(0, 0, 1, 1);
    return new Uint32Array(dot.getImageData(0, 0, 1, 1).data.buffer)[0];
  }
  function draw() {
    var area = canvas.getBoundingClientRect(), scale = window.devicePixelRatio || 1;
    var width = Math.round(area.width * scale), height = Math.round(area.height * scale);
    if (isWhole() || !width || !height) return;
    canvas.width = width;
    canvas.height = height;
    var paint = canvas.getContext("2d"), image = paint.createImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    var colours = stateColours().map(packed), white = packed("#fff"), black = packed("#000"), zoomed = height / (bottom - top);
    var length = range.to - range.from, step = length / width;
    rows.forEach(function (row) {
      var y0 = Math.round((row.y - top) * zoomed), y1 = Math.max(y0 + 1, Math.round((row.y + row.h - top) * zoomed)), tall = y1 - y0;
      for (var x = 0; x < width; ++x) {
        var from = range.from + x * step, time = row.seconds(from, from + step), here = row.present(from, from + step) / step;
        var user = Math.round(time[0] / step * tall), system = Math.round((time[0] + time[1]) / step * tall);
        var message = Math.round((time[0] + time[1] + time[2]) / step * tall), present = Math.round(here * tall);
        for (var k = 0; k < tall; ++k) {
          var y = y1 - 1 - k, state = k < user ? 0 : k < system ? 1 : k < message ? 2 : 3;
          if (state === 3 && k >= present) continue;
          pixels[y * width + x] = mono && state === 2 ? ((x + y) % 4 === 0 ? black : white) : colours[state];
        }
      }
    });
    paint.putImageData(image, 0, 0);
    // Columns wider than a few pixels: what is finer was not embedded.
    plot.classList.toggle("coarse", width / (length / span * data.bins) > 3 * scale);
  }
  function drawMarks(layer) {
    var free = -1e9, marks = (data.marks || []).filter(function (mark) { return mark[0] >= range.from && mark[0] <= range.to; });
    marks.slice(0, 60).forEach(function (mark) {
      var x = Math.floor(xOf(mark[0])) + .5, width = textWidth(mark[1], 12) + 8;
      var named = mark[1] && x > free && x + width < data.right;
      path(layer, "M" + x + " " + (top - 3) + "V" + (bottom + 4), {stroke: colour.ink, "stroke-dasharray": "3 3", "stroke-opacity": .8});
      if (named) { text(layer, x + 4, Math.max(7, top - 8), mark[1]); free = x + width; }
    });
  }
  function update() {
    if (isWhole()) { setNote(timeline, null); return; }
    var layer = liveLayer(timeline, ["labels"]);
    drawAxis(layer, bottom + 6);
    if (top > 14) drawMarks(layer);
    draw();
    setNote(timeline, plot.classList.contains("coarse") ? "finer: stipple view" : "column height = share of the column\u2019s time");
  }
  watchers.push(update);
  redraws.push(update);

  // Values.
  var row = 0;
  function share(value) { return Math.round(value * 100) + "%"; }
  function showTip() {
    if (moment === null || moment < range.from || moment > range.to) { tip.hidden = true; return; }
    var column = Math.min((range.to - range.from) / 400, span), from = clamp(Math.floor((moment - range.from) / column) * column + range.from, range.from, range.to - column);
    var time = rows[row].seconds(from, from + column);
    tip.textContent = "";
    tip.appendChild(make("b", {}, rows[row].name));
    tip.append(formatTime(from).replace(/ .*/, "") + " \u2013 " + formatTime(from + column));
    stateNames.forEach(function (name, s) { tip.append(make("br"), name + " " + share(time[s] / column)); });
    tip.hidden = false;
    var scale = plot.clientWidth / view.width, x = xOf(moment) * scale, left = x + 14;
    if (left + tip.offsetWidth > plot.clientWidth) left = x - tip.offsetWidth - 14;
    tip.style.left = left + "px";
    tip.style.top = (rows[row].y + rows[row].h) * scale + 6 + "px";
  }
  function timeAt(event) {
    var area = glass.getBoundingClientRect();
    return range.from + (range.to - range.from) * clamp((event.clientX - area.left) / area.width, 0, 1);
  }
  function rowAt(event) {
    var area = glass.getBoundingClientRect(), y = top + (event.clientY - area.top) / area.height * (bottom - top), best = 0, least = 1e9;
    rows.forEach(function (some, i) {
      var away = Math.abs(y - some.y - some.h / 2) - some.h / 2;
      if (away < least) { least = away; best = i; }
    });
    return best;
  }
  var start = null;
  glass.addEventListener("pointerdown", function (event) {
    if (event.button !== 0) return;
    start = timeAt(event);
    glass.setPointerCapture(event.pointerId);
    plot.focus({preventScroll: true});
    event.preventDefault();
  });
  function showBand(event) {
    var area = glass.getBoundingClientRect(), one = (start - range.from) / (range.to - range.from) * area.width, other = clamp(event.clientX - area.left, 0, area.width);
    band.hidden = Math.abs(other - one) < 4;
    band.style.left = Math.min(one, other) + "px";
    band.style.width = Math.abs(other - one) + "px";
  }
  glass.addEventListener("pointermove", function (event) {
    row = rowAt(event);
    setMoment(timeAt(event));
    showTip();
    if (start !== null) showBand(event);
  });
  glass.addEventListener("pointerup", function (event) {
    var end = timeAt(event), drawn = !band.hidden;
    band.hidden = true;
    if (start !== null && drawn) setRange(Math.min(start, end), Math.max(start, end));
    start = null;
  });
  glass.addEventListener("pointercancel", function () { start = null; band.hidden = true; });
  glass.addEventListener("pointerleave", function () { if (start === null) { setMoment(null); tip.hidden = true; } });
  glass.addEventListener("dblclick", whole);
  // The wheel turns the page until the timeline is in use.
  glass.addEventListener("wheel", function (event) {
    if (!event.ctrlKey && !plot.contains(document.activeElement)) return;
    event.preventDefault();
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) pan(event.deltaX / 1000);
    else zoom(Math.pow(1.0015, event.deltaY), timeAt(event));
    setMoment(timeAt(event));
  }, {passive: false});
  plot.addEventListener("keydown", function (event) {
    var length = range.to - range.from, column = length / 100, at = moment === null ? range.from + length / 2 : moment;
    var moves = {ArrowLeft: -column, ArrowRight: column, Home: range.from - at, End: range.to - at};
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === "+" || event.key === "=") zoom(.5, at);
    else if (event.key === "-" || event.key === "_") zoom(2, at);
    else if (event.key === "0" || event.key === "Escape") { whole(); if (event.key === "Escape") { setMoment(null); tip.hidden = true; } return event.preventDefault(); }
    else if (event.shiftKey && (event.key === "ArrowLeft" || event.key === "ArrowRight")) { pan(event.key === "ArrowLeft" ? -.25 : .25); at = clamp(at, range.from, range.to); }
    else if (event.key === "ArrowUp") row = Math.max(0, row - 1);
    else if (event.key === "ArrowDown") row = Math.min(rows.length - 1, row + 1);
    else if (event.key in moves) at = clamp(at + moves[event.key], range.from, range.to);
    else return;
    event.preventDefault();
    setMoment(clamp(at, range.from, range.to));
    showTip();
  });
  plot.addEventListener("blur", function () { tip.hidden = true; setMoment(null); });
  momentWatchers.push(function () { if (moment === null) tip.hidden = true; });
})();
