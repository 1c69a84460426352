// SPDX-License-Identifier: MIT
// Numbers as the page writes them, and the data that the panels are drawn from. The script adds;
// nothing is lost without it.
var root = document.documentElement;
root.classList.add("js");
function byId(id) { return document.getElementById(id); }
function all(selector, within) { return Array.from((within || document).querySelectorAll(selector)); }
function clamp(value, low, high) { return Math.min(high, Math.max(low, value)); }
function make(name, attributes, text) {
  var element = document.createElement(name);
  for (var key in attributes || {}) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  return element;
}
function makeSvg(name, attributes, text) {
  var element = document.createElementNS(document.querySelector("svg").namespaceURI, name);
  for (var key in attributes || {}) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  return element;
}

// As stats/number.cpp writes them.
function threeDigits(number) {
  var size = Math.abs(number), digits = size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2;
  return number.toFixed(digits).replace(/\B(?=(\d{3})+(?!\d))/g, digits ? "" : ",");
}
function timeUnit(seconds) {
  return seconds >= 1 ? ["s", 1] : seconds >= 1e-3 ? ["ms", 1e-3] : seconds >= 1e-6 ? ["\u00b5s", 1e-6] : ["ns", 1e-9];
}
function formatSeconds(seconds) {
  if (!(seconds > 0)) return "0 s";
  var unit = timeUnit(seconds * 1.0005);
  return threeDigits(seconds / unit[1]) + " " + unit[0];
}
function byteUnit(bytes) {
  var units = [["TB", 1e12], ["GB", 1e9], ["MB", 1e6], ["kB", 1e3]];
  for (var i = 0; i < units.length; ++i) if (bytes >= units[i][1]) return units[i];
  return ["B", 1];
}
function formatBytes(bytes) {
  var unit = byteUnit(bytes);
  return (unit[1] === 1 ? String(Math.round(bytes)) : threeDigits(bytes / unit[1])) + " " + unit[0];
}
function formatCount(count) { return String(Math.round(count)).replace(/\B(?=(\d{3})+(?!\d))/g, ","); }
function formatShort(number) {
  var units = [["", 1], ["k", 1e3], ["M", 1e6], ["G", 1e9], ["T", 1e12]];
  if (number > 0 && number < 0.1) return "<0.1";
  for (var i = 0; i + 1 < units.length && number >= 999.5 * units[i][1];) ++i;
  var value = number / units[i][1];
  return (value < 9.95 && (i > 0 || value % 1 !== 0) ? value.toFixed(1) : value.toFixed(0)) + units[i][0];
}
// Never 0% or 100% for what is only near it.
function formatPercent(share) {
  if (share <= 0) return "0%";
  if (share >= 1) return "100%";
  return share < 0.005 ? "<1%" : share > 0.995 ? ">99%" : Math.round(share * 100) + "%";
}

// Embedded data.
function bytesOf(base64) {
  var text = atob(base64), bytes = new Uint8Array(text.length);
  for (var i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}
function unpackBits(base64, count) {
  var packed = bytesOf(base64), bytes = new Uint8Array(count), to = 0;
  for (var i = 0; i < packed.length && to < count;) {
    var n = packed[i++];
    if (n < 128) for (var k = 0; k <= n; ++k) bytes[to++] = packed[i++];
    else { bytes.fill(packed[i++], to, to + 258 - n); to += 258 - n; }
  }
  return bytes;
}
function numbersOf(base64) {
  var bytes = bytesOf(base64), numbers = [], value = 0, scale = 1;
  for (var i = 0; i < bytes.length; ++i) {
    value += (bytes[i] & 127) * scale;
    scale *= 128;
    if (bytes[i] < 128) { numbers.push(value); value = 0; scale = 1; }
  }
  return numbers;
}
// sums[i] is the sum of all before i; between whole places it goes straight.
function sumsOf(values) {
  var sums = new Float64Array(values.length + 1);
  for (var i = 0; i < values.length; ++i) sums[i + 1] = sums[i] + values[i];
  return sums;
}
function sumTo(sums, place) {
  var last = sums.length - 1, whole = Math.floor(place);
  if (place <= 0) return 0;
  if (whole >= last) return sums[last];
  return sums[whole] + (sums[whole + 1] - sums[whole]) * (place - whole);
}

// Between two places, by whole columns and parts of those at the ends.
function sumBetween(sums, from, to) { return sumTo(sums, to) - sumTo(sums, from); }
// Numbers of steps, as sums in the unit.
function stepSums(steps) {
  var sums = sumsOf(numbersOf(steps.n));
  for (var i = 0; i < sums.length; ++i) sums[i] *= steps.unit;
  return sums;
}

var source = byId("data"), data = source ? JSON.parse(source.textContent) : {}, hasTime = !!data.rows;
var span = hasTime ? data.end - data.begin : 0, rows = data.rows || [];
rows.forEach(function (row) {
  row.sums = row.s.map(function (text) { return sumsOf(unpackBits(text, data.bins)); });
  row.present = function (from, to) { return Math.max(0, Math.min(to, row.to) - Math.max(from, row.from)); };
  // Seconds of the mean rank of this row between two times.
  row.seconds = function (from, to) {
    var a = (from - data.begin) / span * data.bins, b = (to - data.begin) / span * data.bins, scale = span / data.bins / 255;
    var time = row.sums.map(function (sums) { return (sumTo(sums, b) - sumTo(sums, a)) * scale; });
    time.push(Math.max(0, row.present(from, to) - time[0] - time[1] - time[2]));
    return time;
  };
  delete row.s;
});
var nodes = rows.filter(function (row) { return !row.host; });
var stateNames = ["user computation", "system", "message transmission", "idle"];
if (!nodes.length) nodes = rows;

// Pictures drawn by the script follow the colours of the page.
var redraws = [], mono = !!document.querySelector("#mono-message");
function stateColours() {
  return [0, 1, 2, 3].map(function (s) { return getComputedStyle(root).getPropertyValue("--state" + s).trim(); });
}
function redraw() { redraws.forEach(function (draw) { draw(); }); }
var resizing = 0;
window.addEventListener("resize", function () { cancelAnimationFrame(resizing); resizing = requestAnimationFrame(redraw); });
if (window.matchMedia) window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

// The script's own layer of a picture. The layers named in `kept` stay; all others give way to it
// while a part of the run is shown, and come back for the whole.
function liveLayer(svg, kept) {
  var layer = svg.querySelector(":scope > g.live");
  if (!layer) {
    svg.classList.add("lively");
    all(":scope > g", svg).forEach(function (group) { if (kept.indexOf(group.getAttribute("class")) >= 0) group.classList.add("keep"); });
    layer = makeSvg("g", {"class": "live"});
    svg.appendChild(layer);
  }
  layer.textContent = "";
  return layer;
}
function setNote(element, text) {
  var section = element.closest("section.panel"), note = section && section.querySelector(".note");
  if (!note && section && text !== null) note = section.querySelector("header").appendChild(make("span", {"class": "note"}));
  if (!note) return;
  if (note.dataset.whole === undefined) note.dataset.whole = note.textContent;
  note.textContent = text === null ? note.dataset.whole : text;
}
// Of a panel that does not follow the range.
function saysWhole(element) {
  setNote(element, "");
  var said = element.closest("section.panel").querySelector(".note").dataset.whole;
  setNote(element, said.indexOf("whole run") === 0 ? said : "whole run" + (said ? " \u00b7 " + said : ""));
}
var colour = {ink: "#1f2933", secondary: "#66727f", grid: "#e3e7eb", hairline: "#b8c1ca", accent: "#b42318", quiet: "#c2c9d3", band: "#c9dcef",
  loadFill: "#fae0b4", loadLine: "#b8770a", states: ["#3672b9", "#7a1f3d", "#f0a830", "#e8ebef"]};
function text(layer, x, y, words, options) {
  var size = (options && options.size) || 12, attributes = {x: x, y: y + size * .364, fill: (options && options.fill) || colour.ink, "font-size": size};
  if (options && options.anchor) attributes["text-anchor"] = options.anchor;
  if (options && options.bold) attributes["font-weight"] = 600;
  return layer.appendChild(makeSvg("text", attributes, words));
}
function rectangle(layer, x, y, width, height, fill, tooltip) {
  var rect = layer.appendChild(makeSvg("rect", {x: x.toFixed(2), y: y, width: Math.max(0, width).toFixed(2), height: height, fill: fill}));
  if (tooltip) rect.appendChild(makeSvg("title", {}, tooltip));
  return rect;
}
function path(layer, d, attributes) {
  var element = makeSvg("path", attributes);
  element.setAttribute("d", d);
  return layer.appendChild(element);
}
// The ramp of views/palette.h.
var rampStops = [[0xee, 0xf4, 0xfa], [0x9d, 0xc1, 0xe2], [0x36, 0x72, 0xb9], [0x08, 0x28, 0x56]], rampSteps = 24;
function rampColour(step) {
  var scaled = clamp(step / rampSteps, 0, 1) * 3, stop = Math.min(2, Math.floor(scaled)), share = scaled - stop;
  return "#" + [0, 1, 2].map(function (i) { return ("0" + Math.round(rampStops[stop][i] + (rampStops[stop + 1][i] - rampStops[stop][i]) * share).toString(16)).slice(-2); }).join("");
}
// Rectangles of a drawn layer: views/svg_write.cpp writes them with their lower edge first.
function rectanglesOf(svg, layer) {
  var found = [], shape = /M([\d.-]+) ([\d.-]+)h([\d.]+)v-([\d.]+)h/g;
  all(":scope > g." + layer + " path", svg).forEach(function (drawn) {
    for (var match; (match = shape.exec(drawn.getAttribute("d")));) found.push({x: +match[1], y: match[2] - match[4], width: +match[3], height: +match[4]});
  });
  return found;
}
var measure = document.createElement("canvas").getContext("2d");
function textWidth(words, size, bold) {
  measure.font = (bold ? "600 " : "") + size + "px Inter, 'DejaVu Sans', system-ui, sans-serif";
  return measure.measureText(words).width;
}
