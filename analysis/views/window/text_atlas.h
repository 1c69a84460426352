// SPDX-License-Identifier: MIT
// Texts rendered once and kept in one picture, from which all texts of a frame are drawn. Rendering
// one takes about as long as drawing a thousand rectangles.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_TEXT_ATLAS_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_TEXT_ATLAS_H

#include <vtkSmartPointer.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "analysis/views/window/scene_batch.h"

class vtkTextProperty;

namespace stipple {

class TextAtlas : public TextStore {
 public:
  static constexpr int kWidth = 1024;
  static constexpr int kHeight = 1536;

  TextAtlas();
  ~TextAtlas() override;

  PlacedText Of(const std::string& text, int size, bool bold) override;

  /// Coverage, 0..255, row by row from the top.
  const std::vector<std::uint8_t>& texels() const { return texels_; }
  /// Rows [first, last) changed since the last call.
  std::pair<int, int> TakeChangedRows();
  /// There was no room: forget all, so that the next frame begins anew. Places given before are
  /// void then; the generation tells.
  bool full() const { return full_; }
  void Clear();
  std::uint64_t generation() const { return generation_; }

 private:
  struct Rendered {
    int width = 0, height = 0;
    std::vector<std::uint8_t> texels;
  };
  Rendered Render(const std::string& text, int size, bool bold);
  float BaselineOf(int size, bool bold);
  bool Place(const Rendered& rendered, PlacedText& placed);

  std::map<std::tuple<std::string, int, bool>, PlacedText> placed_;
  std::map<std::pair<int, bool>, float> baselines_;
  std::vector<std::uint8_t> texels_;
  vtkSmartPointer<vtkTextProperty> property_;
  int x_ = 0, y_ = 0, row_height_ = 0;
  int first_changed_ = 0, last_changed_ = 0;
  bool full_ = false;
  std::uint64_t generation_ = 0;
};

}  // namespace stipple

#endif
