// SPDX-License-Identifier: MIT
// What a reader would do with a report, done by a script behind the page's own; what is wrong is
// left in the body's data-problems, figures of a part of the run in data-states.
(function () {
  var problems = [], doc = document.documentElement;
  function all(selector, within) { return Array.from((within || document).querySelectorAll(selector)); }
  function byId(id) { return document.getElementById(id); }
  function expect(right, problem) { if (!right) problems.push(problem); }

  // Tables sort both ways.
  function values(table, column) {
    return Array.from(table.tBodies[0].rows, function (row) {
      var cell = row.cells[column];
      return "v" in cell.dataset ? cell.dataset.v : cell.textContent;
    }).filter(function (value) { return value !== ""; });
  }
  function inOrder(list, text, sign) {
    return list.every(function (value, i) {
      if (i === 0) return true;
      return sign * (text ? list[i - 1].localeCompare(value, "en", {numeric: true}) : list[i - 1] - value) <= 0;
    });
  }
  var tables = all("table.sortable"), sorted = 0;
  tables.forEach(function (table) {
    all("thead th button", table).forEach(function (button) {
      var head = button.parentNode, text = head.dataset.sort === "text";
      for (var click = 0; click < 2; ++click) {
        var before = head.getAttribute("aria-sort");
        button.click();
        var down = head.getAttribute("aria-sort") === "descending";
        expect(down === (text ? before === "ascending" : before !== "descending"), "wrong way: " + button.textContent);
        expect(inOrder(values(table, head.cellIndex), text, down ? -1 : 1), "not sorted: " + button.textContent);
        ++sorted;
      }
    });
  });
  expect(tables.length === 0 || sorted > 0, "no table sorts");

  // What everybody needs: names, one first heading, no level left out, ids that are there once.
  expect(all("h1").length === 1, "not one h1");
  expect(doc.lang === "en", "no language");
  expect(document.title.length > 0, "no title");
  var level = 0;
  all("h1,h2,h3,h4").forEach(function (heading) {
    var next = Number(heading.tagName[1]);
    expect(next <= level + 1, "heading leaves out a level: " + heading.textContent);
    expect(heading.textContent.trim() !== "", "empty heading");
    level = next;
  });
  var seen = {};
  all("[id]").forEach(function (element) { expect(!seen[element.id], "id twice: " + element.id); seen[element.id] = true; });
  all("[aria-labelledby],[aria-describedby],[aria-controls]").forEach(function (element) {
    ["aria-labelledby", "aria-describedby", "aria-controls"].forEach(function (name) {
      (element.getAttribute(name) || "").split(" ").forEach(function (id) { expect(!id || seen[id], "refers to nothing: " + id); });
    });
  });
  all("button,input,select,a[href],[tabindex],summary,[role=region]").forEach(function (control) {
    var label = control.id && document.querySelector("label[for=" + control.id + "]");
    var name = control.getAttribute("aria-label") || control.getAttribute("aria-labelledby") || control.textContent.trim() || (label && label.textContent.trim());
    expect(name, "a control without a name: " + control.outerHTML.slice(0, 80));
  });
  all("svg[role=img]").forEach(function (svg) {
    var title = svg.querySelector("title");
    expect(title && title.textContent.trim(), "a picture without a title: " + svg.getAttribute("class"));
  });
  all("svg:not([role=img])").forEach(function (svg) { expect(svg.closest("[aria-hidden=true]") || svg.getAttribute("aria-hidden") === "true", "a picture that says nothing"); });
  all("table").forEach(function (table) {
    expect(all("th", table).every(function (head) { return head.scope; }), "a table's head without scope");
    expect(table.caption || table.closest("[aria-labelledby]"), "a table without a caption");
  });
  all("nav a").forEach(function (link) { expect(byId(link.hash.slice(1)), "a link to nothing: " + link.hash); });

  // Texts of a picture do not cover each other.
  function overlaps(svg, where) {
    var boxes = all("text", svg).map(function (text) { return {text: text.textContent, box: text.getBoundingClientRect(), scale: svg.getBoundingClientRect().width / svg.viewBox.baseVal.width}; });
    boxes = boxes.filter(function (one) { return one.box.width > 0; });
    if (boxes.length > 1500) return;
    for (var i = 0; i < boxes.length; ++i) for (var k = i + 1; k < boxes.length; ++k) {
      var a = boxes[i].box, b = boxes[k].box, s = boxes[i].scale, over = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      // The box of a line of text is a third higher than its letters.
      var height = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (over > 1.5 * s && height > .34 * Math.min(a.height, b.height)) {
        problems.push(where + ": '" + boxes[i].text + "' covers '" + boxes[k].text + "' in " + svg.getAttribute("class"));
        return;
      }
    }
  }
  function visible(element) { return element.getClientRects().length > 0; }
  function look(where) {
    all("svg[role=img]").forEach(function (svg) { if (visible(svg)) overlaps(svg, where); });
    expect(doc.scrollWidth <= doc.clientWidth + 1, where + ": wider than the window");
  }

  // One page at a time, by its address.
  var pages = all("main > .page"), links = all("nav a");
  pages.forEach(function (page) {
    location.hash = "#" + page.id;
    window.dispatchEvent(new HashChangeEvent("hashchange"));
    pages.forEach(function (other) { expect(visible(other) === (other === page), "page " + other.id + " at #" + page.id); });
    links.forEach(function (link) { expect((link.getAttribute("aria-current") === "page") === (link.hash === "#" + page.id), "current link at #" + page.id); });
    look(page.id);
  });
  if (pages.length) { location.hash = "#" + pages[0].id; window.dispatchEvent(new HashChangeEvent("hashchange")); }

  // The range: by drag, wheel, keys and buttons; panels follow and come back.
  var source = byId("data"), data = source ? JSON.parse(source.textContent) : {}, svg = document.querySelector("svg.view-timeline");
  var glass = document.querySelector(".glass"), plot = document.querySelector(".plot"), bar = byId("range-bar"), text = byId("range-text");
  if (data.rows) {
    expect(bar && !bar.hidden, "no bar with the range");
    var area = glass.getBoundingClientRect(), whole = text.textContent, tip = byId("tip");
    glass.setPointerCapture = function () {};
    function pointer(type, x, y, more) {
      glass.dispatchEvent(new (type === "wheel" ? WheelEvent : PointerEvent)(type, Object.assign({clientX: area.left + area.width * x, clientY: area.top + area.height * y, button: 0, pointerId: 1, bubbles: true, cancelable: true}, more)));
    }
    function key(name, shift) { plot.dispatchEvent(new KeyboardEvent("keydown", {key: name, shiftKey: !!shift, bubbles: true, cancelable: true})); }
    function shownSvg() { return svg.querySelector(":scope > g.live") ? svg.querySelector(":scope > g.live").textContent : ""; }
    // Values under the pointer.
    var top = data.rows[0].y, last = data.rows[data.rows.length - 1], high = last.y + last.h - top;
    data.rows.forEach(function (row) {
      pointer("pointermove", .5, (row.y + row.h / 2 - top) / high);
      var shares = 0;
      tip.innerHTML.replace(/(\d+)%/g, function (all, share) { shares += Number(share); });
      expect(!tip.hidden && tip.textContent.indexOf(row.name) === 0, "no values for " + row.name);
      expect(shares <= 103, "shares of " + row.name + " make " + shares + "%");
      if (row.from <= data.begin && row.to >= data.end) expect(shares >= 97, "shares of " + row.name + " make only " + shares + "%");
    });
    pointer("pointerleave", .5, .5);
    expect(tip.hidden, "values stay");
    // Drag.
    pointer("pointerdown", .25, .5);
    pointer("pointermove", .75, .5);
    pointer("pointerup", .75, .5);
    expect(doc.classList.contains("part"), "a drag chooses nothing");
    expect(text.textContent !== whole, "the bar does not tell the range");
    expect(getComputedStyle(plot.querySelector("canvas")).display === "block", "no canvas");
    var paint = plot.querySelector("canvas"), pixels = paint.getContext("2d").getImageData(0, 0, paint.width, paint.height).data, coloured = 0;
    for (var i = 3; i < pixels.length; i += 4) if (pixels[i]) ++coloured;
    expect(coloured > pixels.length / 4 / 8, "the canvas is empty");
    look("zoomed");
    var table = byId("states-table");
    if (table) document.body.dataset.states = JSON.stringify(Array.from(table.tBodies[0].rows, function (row) { return Array.from(row.cells).slice(1).map(function (cell) { return Number(cell.dataset.v); }); }));
    document.body.dataset.range = text.textContent;
    // Each panel follows the range or says that it does not.
    all("section.panel svg[role=img]").forEach(function (picture) {
      var name = picture.getAttribute("class").split(" ")[0].slice(5), note = picture.closest("section.panel").querySelector(".note");
      if (["detail", "phase-bars", "accuracy", "dials", "now"].indexOf(name) >= 0) return;
      expect(picture.querySelector(":scope > g.live") || (note && note.textContent.indexOf("whole run") === 0), name + " neither follows nor says so");
    });
    var functions = byId("functions-table");
    if (functions && data.functions) {
      var shares = 0;
      all("td.share", functions).forEach(function (cell) { if (!cell.parentNode.hidden) shares += parseInt(cell.textContent, 10) || 0; });
      expect(shares <= 115, "functions take " + shares + "% of the part");
      all("tbody tr[data-f]", functions).forEach(function (row) {
        expect(row.cells[4].dataset.v <= row.cells[3].dataset.v * 1.02 + 1e-6, "more exclusive than inclusive time: " + row.cells[0].textContent);
      });
    }
    // Keys.
    plot.focus();
    var now = text.textContent;
    key("+");
    expect(text.textContent !== now, "+ does nothing");
    now = text.textContent;
    key("ArrowRight", true);
    expect(text.textContent !== now, "Shift and an arrow do nothing");
    key("ArrowLeft");
    expect(!tip.hidden, "an arrow reads nothing");
    key("-");
    key("0");
    expect(text.textContent === whole && !doc.classList.contains("part"), "0 does not show the whole run");
    // Wheel, buttons, double click.
    pointer("wheel", .5, .5, {deltaY: -400});
    expect(doc.classList.contains("part"), "the wheel does nothing");
    pointer("dblclick", .5, .5);
    expect(!doc.classList.contains("part"), "a double click does not show the whole run");
    byId("range-closer").click();
    byId("range-earlier").click();
    expect(doc.classList.contains("part"), "buttons do nothing");
    byId("range-whole").click();
    expect(text.textContent === whole, "a button does not show the whole run");
    all(".note").forEach(function (note) { expect(note.dataset.whole === undefined || note.textContent === note.dataset.whole, "a note stays: " + note.textContent); });
    // Links to moments.
    var link = document.querySelector("a[data-from]");
    if (link) { link.click(); expect(doc.classList.contains("part"), "a wait does not lead to its moment"); byId("range-whole").click(); }
  }
  document.body.dataset.problems = problems.slice(0, 12).join("; ") || "none";
})();
