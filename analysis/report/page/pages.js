// SPDX-License-Identifier: MIT
// One page at a time; the address names it, or anything on it.
var pages = all("main > .page"), links = all("nav a");
function showPage() {
  var name = decodeURIComponent(location.hash.slice(1)), target = name && byId(name);
  var page = (target && target.closest(".page")) || pages[0];
  if (!page) return;
  pages.forEach(function (other) { other.classList.toggle("current", other === page); });
  links.forEach(function (link) {
    if (link.hash === "#" + page.id) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  });
  // Behind the browser's own scrolling to the name.
  if (target) setTimeout(function () {
    if (target === page) window.scrollTo({top: 0, behavior: "instant"});
    else target.scrollIntoView();
  }, 0);
  window.dispatchEvent(new Event("resize"));
}
window.addEventListener("hashchange", showPage);
showPage();
