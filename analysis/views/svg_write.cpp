// SPDX-License-Identifier: MIT
#include "analysis/views/svg_write.h"

#include <fmt/format.h>
#include <vtkXMLDataElement.h>

#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::string_view kFontFamily = "Inter,'DejaVu Sans',system-ui,sans-serif";

/// Half the height of capitals over the font size, in Inter as in DejaVu Sans. Baselines are placed
/// by it because not every renderer knows `dominant-baseline`.
constexpr double kMiddleOverBaseline = 0.364;

/// How the device writes a line that shall not be seen.
constexpr std::string_view kNoPenDashes = "0,10";

std::string_view Attribute(vtkXMLDataElement* element, const char* name) {
  const char* value = element->GetAttribute(name);
  return value == nullptr ? std::string_view{} : std::string_view{value};
}

std::string_view Name(vtkXMLDataElement* element) {
  return element->GetName() == nullptr ? std::string_view{} : element->GetName();
}

/// All numbers of a point list or path; letters and commas separate.
std::vector<double> Numbers(std::string_view text) {
  std::vector<double> numbers;
  const std::string owned(text);
  const char* place = owned.c_str();
  while (*place != '\0') {
    char* after = nullptr;
    const double number = std::strtod(place, &after);
    if (after == place) {
      ++place;
      continue;
    }
    numbers.push_back(number);
    place = after;
  }
  return numbers;
}

/// Hundredths of a pixel, so that relative steps add up exactly.
long long Hundredths(double pixels) { return std::llround(pixels * 100); }

std::string Decimal(long long hundredths) {
  if (hundredths % 100 == 0) return fmt::format("{}", hundredths / 100);
  std::string text = fmt::format("{}{}.{:02}", hundredths < 0 ? "-" : "",
                                 std::llabs(hundredths) / 100, std::llabs(hundredths) % 100);
  if (text.back() == '0') text.pop_back();
  return text;
}

/// "M10 20h5v-3l2 2z": relative steps are the shortest form of a step-shaped outline.
std::string CompactPath(const std::vector<double>& numbers, bool closed) {
  std::string path;
  long long x = 0, y = 0;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    const long long next_x = Hundredths(numbers[i]), next_y = Hundredths(numbers[i + 1]);
    if (i == 0)
      path += fmt::format("M{} {}", Decimal(next_x), Decimal(next_y));
    else if (next_x != x && next_y != y)
      path += fmt::format("l{} {}", Decimal(next_x - x), Decimal(next_y - y));
    else if (next_x != x)
      path += 'h' + Decimal(next_x - x);
    else if (next_y != y)
      path += 'v' + Decimal(next_y - y);
    x = next_x;
    y = next_y;
  }
  return closed ? path + 'z' : path;
}

std::string AttributeText(std::string_view name, std::string_view value) {
  return fmt::format(" {}=\"{}\"", name, EscapeMarkup(value));
}

/// Attributes of fill and stroke that say something; the rest is SVG's default.
std::string Paint(vtkXMLDataElement* element) {
  std::string text;
  for (const char* name :
       {"fill", "fill-opacity", "stroke", "stroke-opacity", "stroke-width", "stroke-dasharray"}) {
    const std::string_view value = Attribute(element, name);
    const bool is_default = value.empty() || (value == "1" && std::string_view(name) != "fill");
    if (is_default) continue;
    const bool dashes = std::string_view(name) == "stroke-dasharray";
    text += AttributeText(name, dashes ? "3 3" : value);
  }
  return text;
}

std::string TextElement(vtkXMLDataElement* element) {
  const std::string_view anchor = Attribute(element, "text-anchor");
  const std::string_view transform = Attribute(element, "transform");
  const std::vector<double> place = Numbers(transform);  // translate(x,y)rotate(a)
  std::string text = "<text";
  // The device calls its pixels points.
  const std::vector<double> sizes = Numbers(Attribute(element, "font-size"));
  const double size = sizes.empty() ? 12 : sizes[0], drop = size * kMiddleOverBaseline;
  if (place.size() >= 3)
    text += fmt::format(" transform=\"translate({},{})rotate(-90)\" y=\"{}\"",
                        Decimal(Hundredths(place[0])), Decimal(Hundredths(place[1])),
                        Decimal(Hundredths(drop)));
  else if (place.size() == 2)
    text += fmt::format(" x=\"{}\" y=\"{}\"", Decimal(Hundredths(place[0])),
                        Decimal(Hundredths(place[1] + drop)));
  text += AttributeText("fill", Attribute(element, "fill"));
  text += AttributeText("font-size", Decimal(Hundredths(size)));
  if (Attribute(element, "font-weight") == "bold") text += " font-weight=\"600\"";
  if (anchor == "right" || anchor == "end") text += " text-anchor=\"end\"";
  if (anchor == "middle" || anchor == "center") text += " text-anchor=\"middle\"";
  const char* content = element->GetCharacterData();
  return text + '>' + EscapeMarkup(content == nullptr ? "" : content) + "</text>";
}

/// A path or line: what it is painted with, its outline, its tooltip.
struct Drawn {
  std::string paint, outline, tooltip;

  /// Opaque neighbours of one colour may become one element; with tooltips they may not.
  bool Joins(const Drawn& next) const {
    return paint == next.paint && tooltip.empty() && next.tooltip.empty() &&
           paint.find("opacity") == std::string::npos;
  }
  std::string Text() const {
    if (outline.empty()) return {};
    const std::string open = "<path" + paint + AttributeText("d", outline);
    if (tooltip.empty()) return open + "/>";
    return open + "><title>" + EscapeMarkup(tooltip) + "</title></path>";
  }
};

Drawn DrawnOf(vtkXMLDataElement* element) {
  Drawn drawn;
  drawn.paint = Paint(element);
  const bool line = Name(element) == "polyline";
  const std::string_view outline = Attribute(element, line ? "points" : "d");
  drawn.outline = CompactPath(Numbers(outline), !line);
  if (element->GetNumberOfNestedElements() > 0) {
    const char* title = element->GetNestedElement(0)->GetCharacterData();
    if (title != nullptr) drawn.tooltip = title;
  }
  return drawn;
}

std::string GroupText(vtkXMLDataElement* group) {
  std::string text;
  Drawn pending;
  const auto flush = [&] {
    text += pending.Text();
    pending = {};
  };
  for (int i = 0; i < group->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* element = group->GetNestedElement(i);
    if (Name(element) == "text") {
      flush();
      text += TextElement(element);
      continue;
    }
    const bool path = Name(element) == "path", line = Name(element) == "polyline";
    if ((!path && !line) || Attribute(element, "stroke-dasharray") == kNoPenDashes) continue;
    Drawn drawn = DrawnOf(element);
    if (!pending.outline.empty() && pending.Joins(drawn)) {
      pending.outline += drawn.outline;
      continue;
    }
    flush();
    pending = std::move(drawn);
  }
  flush();
  const std::string_view name = Attribute(group, "class");
  return "<g" + (name.empty() ? "" : AttributeText("class", name)) + '>' + text + "</g>\n";
}

}  // namespace

std::string EscapeMarkup(std::string_view text) {
  std::string escaped;
  for (const char letter : CleanUtf8(text)) {
    switch (letter) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += letter;
    }
  }
  return escaped;
}

std::string WriteSvg(const Scene& scene, vtkXMLDataElement* root, const SvgOptions& options) {
  std::string text = "<svg";
  if (options.standalone)
    text += fmt::format(" xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\"",
                        scene.width, scene.height);
  text += fmt::format(
      " class=\"view-{0}\" viewBox=\"0 0 {1} {2}\" role=\"img\" aria-labelledby=\"{0}-title "
      "{0}-description\" fill=\"none\" font-family=\"{3}\">\n",
      scene.name, scene.width, scene.height, kFontFamily);
  text +=
      fmt::format("<title id=\"{0}-title\">{1}</title><desc id=\"{0}-description\">{2}</desc>\n",
                  scene.name, EscapeMarkup(scene.title), EscapeMarkup(scene.description));
  // Sharp edges for areas only; lines and text stay smooth.
  text +=
      "<style>.states path,.cells path,.bars path{shape-rendering:crispEdges}"
      ".letters text,.marks "
      "text{paint-order:stroke;stroke:var(--ground,#fff);stroke-width:3px}</style>\n";
  for (int i = 0; i < root->GetNumberOfNestedElements(); ++i)
    text += GroupText(root->GetNestedElement(i));
  return text + "</svg>\n";
}

}  // namespace stipple
