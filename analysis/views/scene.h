// SPDX-License-Identifier: MIT
// What a view is before it is drawn: shapes and texts in pixels, y downwards. Layout makes scenes
// and knows no VTK; drawing (svg.h) knows nothing else.
#ifndef STIPPLE_ANALYSIS_VIEWS_SCENE_H
#define STIPPLE_ANALYSIS_VIEWS_SCENE_H

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace stipple {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(Colour, Colour) = default;
};

struct Point {
  double x = 0, y = 0;
};

/// A filled rectangle; a tooltip, where given, is shown by browsers and read by screen readers.
struct RectShape {
  double x = 0, y = 0, width = 0, height = 0;
  Colour fill;
  std::string tooltip;
};

struct PolygonShape {
  std::vector<Point> points;
  Colour fill;
};

struct LineShape {
  std::vector<Point> points;
  Colour stroke;
  double width = 1;
  bool dashed = false;
  double opacity = 1;
};

enum class Anchor { kStart, kMiddle, kEnd };

struct TextStyle {
  double size = 12;
  Colour colour;
  bool bold = false;
  Anchor anchor = Anchor::kStart;
  bool upwards = false;  // turned by 90 degrees, read from below
};

/// One line of text; (x, y) is the anchor, vertically the middle of the line.
struct TextShape {
  double x = 0, y = 0;
  std::string text;
  TextStyle style;
};

using Shape = std::variant<RectShape, PolygonShape, LineShape, TextShape>;

/// Shapes drawn together; the name becomes the SVG group's class, for style sheets and scripts.
struct Layer {
  std::string name{};
  std::vector<Shape> shapes;
};

/// What a colour means; drawn beside the heading by whoever puts the scene on a page.
struct KeyEntry {
  std::string label{};
  Colour colour{};
  bool line = false;  // a stroke, else a square
  bool dashed = false;
};

struct Scene {
  std::string name{};         // unique on a page: prefix of element ids
  double width = 0;           // pixels
  double height = 0;          // pixels
  std::string title{};        // one line, for screen readers
  std::string description{};  // what the picture shows, in words
  std::string note{};         // unit or key, shown beside the heading
  std::vector<Layer> layers{};
  std::vector<KeyEntry> key{};
};

}  // namespace stipple

#endif
