// SPDX-License-Identifier: MIT
#include "analysis/views/sheet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/views/palette.h"
#include "analysis/views/scene_grid.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kMargin = 24, kTitleSize = 15, kTextSize = 12;
constexpr double kTitleLine = 26, kKeyLine = 22;
constexpr double kSwatch = 12, kStroke = 20;
constexpr double kLeastWidth = 520;  // of a sheet, so that titles have room

/// Titles begin as sentences; names of columns with an underscore stay as they are.
std::string Capitalised(std::string title) {
  const bool name = title.substr(0, title.find(' ')).find('_') != title.npos;
  if (!name && !title.empty() && title[0] >= 'a' && title[0] <= 'z')
    title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return title;
}

/// What the texts above the scene take, line by line.
struct Head {
  Layer layer{"head", {}};
  double width = 0;  // of the sheet without margins
  double y = kMargin;

  void AddTitle(const Scene& scene) {
    if (scene.title.empty()) return;
    layer.shapes.emplace_back(
        TextShape{kMargin,
                  y + 8,
                  ShortenEnd(Capitalised(scene.title), width / 1.12, kTitleSize),
                  {.size = kTitleSize, .colour = kInk, .bold = true}});
    y += kTitleLine;
  }

  /// Below the title, in as many lines as it takes.
  void AddKey(const std::vector<KeyEntry>& key) {
    if (key.empty()) return;
    double x = kMargin;
    for (const KeyEntry& entry : key) {
      const double mark = entry.line ? kStroke : kSwatch;
      const std::string label = ShortenEnd(entry.label, width - mark - 7, kTextSize);
      const double needed = mark + 7 + TextWidth(label, kTextSize);
      if (x > kMargin && x + needed > kMargin + width) x = kMargin, y += kKeyLine;
      AddMark(entry, x);
      layer.shapes.emplace_back(
          TextShape{x + mark + 7, y + 8, label, {.size = kTextSize, .colour = kInk}});
      x += needed + 20;
    }
    y += kKeyLine + 4;
  }

  void AddMark(const KeyEntry& entry, double x) {
    if (entry.line) {
      layer.shapes.emplace_back(LineShape{{{x, y + 8}, {x + kStroke, y + 8}},
                                          entry.colour,
                                          entry.dashed ? 1.25 : 2,
                                          entry.dashed,
                                          1});
      return;
    }
    // A thin frame, so that pale squares are squares.
    layer.shapes.emplace_back(
        RectShape{x - 0.75, y + 1.25, kSwatch + 1.5, kSwatch + 1.5, kHairline, {}});
    layer.shapes.emplace_back(RectShape{x, y + 2, kSwatch, kSwatch, entry.colour, {}});
  }

  void AddNote(const std::string& note) {
    if (note.empty()) return;
    layer.shapes.emplace_back(TextShape{kMargin,
                                        y + 6,
                                        ShortenEnd(note, width, kTextSize),
                                        {.size = kTextSize, .colour = kSecondary}});
    y += kKeyLine;
  }
};

/// An archive may lack what a display shows: that is said, it is no error.
Scene NothingToShow(const Scene& scene) {
  Scene sheet{.name = scene.name, .width = kLeastWidth, .height = 96, .title = "Nothing to show"};
  sheet.description = "The archive holds nothing that this display shows.";
  sheet.layers = {
      {"head",
       {TextShape{kMargin, 34, sheet.title, {.size = kTitleSize, .colour = kInk, .bold = true}},
        TextShape{kMargin, 60, sheet.description, {.size = kTextSize, .colour = kSecondary}}}}};
  return sheet;
}

}  // namespace

Scene OnSheet(Scene scene) {
  if (scene.layers.empty()) return NothingToShow(scene);
  Head head;
  head.width = std::max(scene.width, kLeastWidth);
  head.AddTitle(scene);
  head.AddNote(scene.note);
  head.AddKey(scene.key);
  const double top = std::ceil(head.y + 4);
  for (Layer& layer : scene.layers)
    for (Shape& shape : layer.shapes) MoveShape(shape, kMargin, top);
  scene.layers.insert(scene.layers.begin(), std::move(head.layer));
  scene.width = std::ceil(head.width + 2 * kMargin);
  scene.height = std::ceil(scene.height + top + kMargin);
  return scene;
}

}  // namespace stipple
