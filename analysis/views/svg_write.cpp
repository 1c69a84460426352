// SPDX-License-Identifier: MIT
#include "analysis/views/svg_write.h"

#include <fmt/format.h>
#include <vtkXMLDataElement.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::string_view kFontFamily = "Inter,'DejaVu Sans',system-ui,sans-serif";

/// Half the height of capitals over the font size, in Inter as in DejaVu Sans. Baselines are placed
/// by it because not every renderer knows `dominant-baseline`.
constexpr double kMiddleOverBaseline = 0.364;

/// Diagonal lines for message transmission.
constexpr std::string_view kMonoPattern =
    "<defs><pattern id=\"mono-message\" width=\"4\" height=\"4\" patternUnits=\"userSpaceOnUse\" "
    "patternTransform=\"rotate(45)\"><rect width=\"4\" height=\"4\" fill=\"#fff\"/>"
    "<rect width=\"1.4\" height=\"4\" fill=\"#000\"/></pattern></defs>\n";

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

/// What a colour becomes where there are none: states have greys and a pattern of their own, all
/// else the grey of its lightness.
std::string Grey(std::string_view colour) {
  constexpr std::string_view kFills[kStateCount] = {"#6b6b6b", "#000000", "url(#mono-message)",
                                                    "#f1f1f1"};
  if (colour.size() != 7 || colour[0] != '#') return std::string(colour);
  const long rgb = std::strtol(std::string(colour.substr(1)).c_str(), nullptr, 16);
  const Colour read{static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 255),
                    static_cast<std::uint8_t>(rgb & 255)};
  for (std::size_t s = 0; s < kStateCount; ++s)
    if (read == kStateColours[s]) return std::string(kFills[s]);
  const int grey =
      static_cast<int>(std::lround(0.299 * read.red + 0.587 * read.green + 0.114 * read.blue));
  return fmt::format("#{0:02x}{0:02x}{0:02x}", grey);
}

/// Dashes in place of the colours of lines.
std::string_view DashesFor(std::string_view stroke) {
  struct Dashes {
    Colour colour;
    std::string_view dashes;
  };
  constexpr Dashes kDashes[] = {{kLoadLine, "8 3"}, {kTeal, "2 2"}, {kStateColours[1], "8 3 2 3"}};
  for (const Dashes& d : kDashes)
    if (stroke == fmt::format("#{:02x}{:02x}{:02x}", d.colour.red, d.colour.green, d.colour.blue))
      return d.dashes;
  return {};
}

/// Attributes of fill and stroke that say something; the rest is SVG's default.
std::string Paint(vtkXMLDataElement* element, bool mono) {
  std::string text;
  const std::string_view stroke = Attribute(element, "stroke");
  if (mono && Attribute(element, "stroke-dasharray").empty() && !DashesFor(stroke).empty())
    text += AttributeText("stroke-dasharray", DashesFor(stroke));
  for (const char* name :
       {"fill", "fill-opacity", "stroke", "stroke-opacity", "stroke-width", "stroke-dasharray"}) {
    const std::string_view value = Attribute(element, name);
    const bool is_default = value.empty() || (value == "1" && std::string_view(name) != "fill");
    if (is_default) continue;
    const bool dashes = std::string_view(name) == "stroke-dasharray";
    const bool colour = std::string_view(name) == "fill" || std::string_view(name) == "stroke";
    // A pattern is no colour for a thin line.
    const std::string grey = mono && colour ? Grey(value) : std::string(value);
    const bool hatched_line = std::string_view(name) == "stroke" && grey.starts_with("url");
    text += AttributeText(name, dashes ? "3 3" : hatched_line ? "#555555" : grey);
  }
  return text;
}

std::string TextElement(vtkXMLDataElement* element, bool mono) {
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
  const std::string_view fill = Attribute(element, "fill");
  const std::string grey = mono ? Grey(fill) : std::string(fill);
  text += AttributeText("fill", grey.starts_with("url") ? "#555555" : grey);
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

Drawn DrawnOf(vtkXMLDataElement* element, bool mono) {
  Drawn drawn;
  drawn.paint = Paint(element, mono);
  const bool line = Name(element) == "polyline";
  const std::string_view outline = Attribute(element, line ? "points" : "d");
  drawn.outline = CompactPath(Numbers(outline), !line);
  if (element->GetNumberOfNestedElements() > 0) {
    const char* title = element->GetNestedElement(0)->GetCharacterData();
    if (title != nullptr) drawn.tooltip = title;
  }
  return drawn;
}

std::string GroupText(vtkXMLDataElement* group, bool mono) {
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
      text += TextElement(element, mono);
      continue;
    }
    const bool path = Name(element) == "path", line = Name(element) == "polyline";
    if ((!path && !line) || Attribute(element, "stroke-dasharray") == kNoPenDashes) continue;
    Drawn drawn = DrawnOf(element, mono);
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
  // Sharp edges for areas only; lines and text stay smooth. A file of its own has no variables.
  text += fmt::format(
      "<style>.states path,.cells path,.bars path{{shape-rendering:crispEdges}}"
      ".letters text,.marks "
      "text{{paint-order:stroke;stroke:{};stroke-width:3px}}</style>\n",
      options.standalone ? "#fff" : "var(--ground,#fff)");
  if (options.mono) text += kMonoPattern;
  for (int i = 0; i < root->GetNumberOfNestedElements(); ++i)
    text += GroupText(root->GetNestedElement(i), options.mono);
  return text + "</svg>\n";
}

}  // namespace stipple
