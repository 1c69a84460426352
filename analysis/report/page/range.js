// SPDX-License-Identifier: MIT
// The part of the run that all panels show, and the moment under the pointer; the bar at the top of
// every page with both.
var range = {from: data.begin, to: data.end}, moment = null, watchers = [], momentWatchers = [];
function isWhole() { return range.to - range.from >= span * (1 - 1e-9); }
function shortest() { return span / data.bins * 4; }
function setRange(from, to) {
  var length = clamp(to - from, Math.min(span, shortest()), span);
  if (length !== to - from) { var middle = (from + to) / 2; from = middle - length / 2; }
  from = clamp(from, data.begin, data.end - length);
  if (from === range.from && from + length === range.to) return;
  range = {from: from, to: length === span ? data.end : from + length};
  root.classList.toggle("part", !isWhole());
  watchers.forEach(function (watch) { watch(); });
  if (moment !== null) setMoment(moment);
}
function whole() { setRange(data.begin, data.end); }
// Keeps the time at `at` where it is.
function zoom(factor, at) {
  if (at === undefined) at = (range.from + range.to) / 2;
  setRange(at - (at - range.from) * factor, at + (range.to - at) * factor);
}
function pan(share) {
  var by = (range.to - range.from) * share, length = range.to - range.from;
  var from = clamp(range.from + by, data.begin, data.end - length);
  setRange(from, from + length);
}
function setMoment(time) {
  moment = time === null ? null : clamp(time, data.begin, data.end);
  momentWatchers.forEach(function (watch) { watch(); });
}
// Digits that tell apart what a thousandth of the range is.
function formatTime(time, length) {
  var unit = timeUnit(Math.max(range.to, 1e-9)), digits = clamp(Math.ceil(3 - Math.log10((length || range.to - range.from) / unit[1])), 0, 9);
  return (time / unit[1]).toFixed(digits) + " " + unit[0];
}
function formatRange(from, to) {
  return formatTime(from, to - from).replace(/ .*/, "") + "\u2013" + formatTime(to, to - from);
}

var bar = byId("range-bar");
if (hasTime && bar) (function () {
  bar.hidden = false;
  var strip = byId("overview"), canvas = strip.querySelector("canvas"), box = strip.querySelector(".box"), line = strip.querySelector(".moment");
  var text = byId("range-text"), said = byId("range-said"), timer = 0;
  [["earlier", function () { pan(-.5); }], ["later", function () { pan(.5); }], ["closer", function () { zoom(.5, moment === null ? undefined : clamp(moment, range.from, range.to)); }],
    ["wider", function () { zoom(2); }], ["whole", whole]].forEach(function (pair) { byId("range-" + pair[0]).addEventListener("click", pair[1]); });

  function draw() {
    var scale = window.devicePixelRatio || 1, width = Math.round(strip.clientWidth * scale), height = Math.round(strip.clientHeight * scale);
    if (!width || !height) return;
    canvas.width = width;
    canvas.height = height;
    var paint = canvas.getContext("2d"), colours = stateColours();
    paint.fillStyle = colours[3];
    paint.fillRect(0, 0, width, height);
    for (var x = 0; x < width; ++x) {
      var from = data.begin + span * x / width, to = data.begin + span * (x + 1) / width, top = height, sums = [0, 0, 0];
      nodes.forEach(function (row) { row.seconds(from, to).forEach(function (time, s) { if (s < 3) sums[s] += time / (to - from) / nodes.length; }); });
      for (var s = 0; s < 3; ++s) {
        var next = top - sums[s] * height;
        paint.fillStyle = colours[s];
        paint.fillRect(x, next, 1, top - next);
        top = next;
      }
    }
  }
  function place() {
    box.style.left = (range.from - data.begin) / span * 100 + "%";
    box.style.width = (range.to - range.from) / span * 100 + "%";
    box.hidden = isWhole();
    byId("range-whole").disabled = byId("range-wider").disabled = isWhole();
    byId("range-earlier").disabled = range.from <= data.begin;
    byId("range-later").disabled = range.to >= data.end;
    byId("range-closer").disabled = range.to - range.from <= shortest() * 1.001;
    text.textContent = isWhole() ? "whole run, " + formatSeconds(span) : formatRange(range.from, range.to) + " (" + formatSeconds(range.to - range.from) + ")";
    clearTimeout(timer);
    timer = setTimeout(function () { said.textContent = rangeSentence(); }, 400);
  }
  function timeAt(event) {
    var area = strip.getBoundingClientRect();
    return data.begin + span * clamp((event.clientX - area.left) / area.width, 0, 1);
  }
  var grip = null;
  strip.addEventListener("pointerdown", function (event) {
    var time = timeAt(event), inside = !isWhole() && time >= range.from && time <= range.to;
    grip = inside ? {offset: time - range.from} : {start: time};
    strip.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  strip.addEventListener("pointermove", function (event) {
    var time = timeAt(event);
    if (!grip) return setMoment(time);
    if ("offset" in grip) pan((time - grip.offset - range.from) / (range.to - range.from));
    else if (Math.abs(time - grip.start) > span / 200) setRange(Math.min(time, grip.start), Math.max(time, grip.start));
  });
  strip.addEventListener("pointerup", function (event) {
    if (grip && "start" in grip && Math.abs(timeAt(event) - grip.start) <= span / 200 && !isWhole()) {
      var half = (range.to - range.from) / 2;
      setRange(grip.start - half, grip.start + half);
    }
    grip = null;
  });
  strip.addEventListener("pointerleave", function () { if (!grip) setMoment(null); });
  strip.addEventListener("dblclick", whole);
  momentWatchers.push(function () {
    line.hidden = moment === null;
    if (moment !== null) line.style.left = (moment - data.begin) / span * 100 + "%";
  });
  watchers.push(place);
  redraws.push(draw);
  place();
})();

// What the range shows in one sentence, for those who do not see it.
function rangeSentence() {
  var computing = nodes.map(function (row) { return row.seconds(range.from, range.to)[0]; });
  var sum = computing.reduce(function (a, b) { return a + b; }, 0) / nodes.length, most = Math.max.apply(null, computing);
  var share = sum / (range.to - range.from);
  return (isWhole() ? "The whole run: " : formatRange(range.from, range.to) + ": ") + data.noun + "s compute " + formatPercent(share) +
    " of the time" + (nodes.length > 1 && sum > 0 ? ", the busiest " + (most / sum).toFixed(2) + " times the mean" : "") + ".";
}

// Waits and such lead to their moment.
all("[data-from]").forEach(function (link) {
  if (!hasTime) return;
  link.addEventListener("click", function () { setRange(+link.dataset.from, +link.dataset.to); });
});
