// SPDX-License-Identifier: MIT
// Tables: a click on a column's name sorts by it.
all("table.sortable").forEach(function (table) {
  table.sortAgain = function () {
    var head = table.querySelector("th[aria-sort]"), body = table.tBodies[0], lines = Array.from(body.rows);
    if (!head) return;
    var column = head.cellIndex, down = head.getAttribute("aria-sort") === "descending", text = head.dataset.sort === "text";
    var value = function (row) { var cell = row.cells[column]; return "v" in cell.dataset ? cell.dataset.v : cell.textContent; };
    lines.sort(function (a, b) {
      var one = value(a), other = value(b);
      if (one === "" || other === "") return (one === "") - (other === "");  // unknown comes last
      var order = text ? one.localeCompare(other, "en", {numeric: true}) : one - other;
      return down ? -order : order;
    });
    lines.forEach(function (row) { body.appendChild(row); });
  };
  all("thead th", table).forEach(function (head) {
    if (!head.dataset.sort) return;
    var button = make("button", {type: "button"}, head.textContent);
    head.textContent = "";
    head.appendChild(button);
    button.addEventListener("click", function () {
      var down = head.getAttribute("aria-sort") !== "descending", text = head.dataset.sort === "text";
      if (text) down = head.getAttribute("aria-sort") === "ascending";
      all("th[aria-sort]", table).forEach(function (other) { other.removeAttribute("aria-sort"); });
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      table.sortAgain();
    });
  });
});
