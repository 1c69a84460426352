// SPDX-License-Identifier: MIT
#include "analysis/report/html_panel.h"

#include <fmt/format.h>

#include "analysis/views/layout.h"
#include "analysis/views/svg.h"
#include "analysis/views/svg_write.h"

namespace stipple {
namespace {

/// What colours mean, drawn as pictures are, so that they follow the page's colours.
std::string KeyText(const std::vector<KeyEntry>& key) {
  std::string text = "<ul class=\"legend\">";
  for (const KeyEntry& entry : key)
    text += fmt::format(
        "<li><svg class=\"swatch\" viewBox=\"0 0 12 12\" aria-hidden=\"true\"><g class=\"cells\">"
        "<path fill=\"#{:02x}{:02x}{:02x}\" d=\"M0 {}h12v{}h-12z\"/></g></svg>{}</li>",
        entry.colour.red, entry.colour.green, entry.colour.blue, entry.line ? 4.5 : 0,
        entry.line ? 3 : 12, EscapeMarkup(entry.label));
  return text + "</ul>";
}

}  // namespace

std::string PanelAround(const Panel& panel, const std::string& content) {
  std::string text = fmt::format(
      "<section class=\"panel {0}\" id=\"{1}\" aria-labelledby=\"h-{1}\"><header "
      "class=\"panel{2}\">"
      "<h3 id=\"h-{1}\">{3}</h3>{4}",
      panel.style, panel.id, panel.end_note ? " end" : "", EscapeMarkup(panel.heading),
      panel.beside);
  if (!panel.note.empty())
    text += fmt::format("<span class=\"note\">{}</span>", EscapeMarkup(panel.note));
  return text + "</header>\n" + content + panel.below + "</section>\n";
}

std::string PanelText(const Panel& panel, const Scene& scene) {
  if (scene.layers.empty()) return {};
  Panel named = panel;
  if (named.id.empty()) named.id = scene.name;
  if (named.note.empty()) named.note = scene.note;
  if (named.beside.empty() && scene.key.size() > 1) named.beside = KeyText(scene.key);
  // A narrow picture is not blown up to the whole width.
  const std::string limit = named.style == "main" && scene.width < kMainWidth
                                ? fmt::format(" style=\"max-width:{:.0f}px\"", scene.width)
                                : "";
  return PanelAround(named, "<figure" + limit + ">" + DrawSvg(scene) + "</figure>");
}

std::string PanelWithout(const Panel& panel, std::string_view sentence) {
  return PanelAround(panel, fmt::format("<p class=\"without\">{}</p>", EscapeMarkup(sentence)));
}

std::string PanelRow(const std::string& panels, std::string_view style) {
  if (panels.empty()) return {};
  return fmt::format("<div class=\"line {}\">{}</div>\n", style, panels);
}

}  // namespace stipple
