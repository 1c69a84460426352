// SPDX-License-Identifier: MIT
// The nodes at a moment, on their page: a dial of utilisation and a lamp with the state of each. They
// follow the pointer in any time panel, and a slider.
(function () {
  var page = byId("nodes"), most = 64;
  if (!hasTime || !page || rows.length < 2 || rows.length > most) return;
  var section = make("section", {"class": "panel", id: "now", "aria-labelledby": "h-now"}), header = make("header", {"class": "panel"});
  var heading = make("h3", {id: "h-now"}), slider = make("input", {type: "range", min: 0, max: 1000, value: 500, "aria-label": "Moment of the run"});
  var note = make("span", {"class": "note"}), across = Math.min(rows.length, 10), wide = 1500 / Math.max(across, 8), tall = 104;
  header.append(heading, slider, note);
  var svg = makeSvg("svg", {"class": "view-now", role: "img", viewBox: "0 0 1500 " + Math.ceil(rows.length / across) * tall, fill: "none", "font-family": "inherit", "aria-labelledby": "now-title"});
  svg.appendChild(makeSvg("title", {id: "now-title"}, "Utilisation and state of each " + data.noun + " at a moment"));
  section.append(header, svg);
  page.insertBefore(section, page.querySelector(".line, section"));
  function arc(x, y, radius, share) {
    var angle = Math.PI * (1 - share);
    return "M" + (x - radius) + " " + y + "A" + radius + " " + radius + " 0 0 1 " + (x + radius * Math.cos(angle)).toFixed(2) + " " + (y - radius * Math.sin(angle)).toFixed(2);
  }
  var dials = rows.map(function (row, i) {
    var x = (i % across + .5) * wide, y = Math.floor(i / across) * tall + 62;
    path(svg, arc(x, y, 40, 1), {stroke: colour.grid, "stroke-width": 12});
    var dial = {value: path(svg, "", {stroke: colour.states[0], "stroke-width": 12}), percent: text(svg, x, y - 8, "", {size: 17, bold: true, anchor: "middle"}),
      lamp: svg.appendChild(makeSvg("circle", {r: 6, stroke: colour.hairline, cx: x - textWidth(row.name, 13) / 2 - 10, cy: y + 18})), x: x, y: y};
    text(svg, x + 4, y + 18, row.name, {size: 13, anchor: "middle"});
    return dial;
  });
  function draw() {
    var at = moment === null ? data.begin + span * slider.value / 1000 : moment, width = windowOf();
    var from = Math.max(data.begin, at - width / 2), to = Math.min(data.end, at + width / 2), short = span / data.bins;
    slider.value = Math.round((at - data.begin) / span * 1000);
    slider.setAttribute("aria-valuetext", formatTime(at));
    heading.textContent = "At " + formatTime(at);
    note.textContent = "dial: share computing in " + formatWindow(width) + " around it \u00b7 lamp: state at it";
    rows.forEach(function (row, i) {
      var share = clamp(row.seconds(from, to)[0] / (to - from), 0, 1), now = row.seconds(Math.max(data.begin, at - short / 2), Math.min(data.end, at + short / 2));
      var state = now.indexOf(Math.max.apply(null, now));
      dials[i].value.setAttribute("d", share > 0 ? arc(dials[i].x, dials[i].y, 40, share) : "");
      dials[i].percent.textContent = formatPercent(share);
      dials[i].lamp.setAttribute("fill", colour.states[state]);
    });
  }
  slider.addEventListener("input", function () { setMoment(data.begin + span * slider.value / 1000); });
  momentWatchers.push(draw);
  watchers.push(draw);
  draw();
})();
