// SPDX-License-Identifier: MIT
#include "analysis/views/window/text_atlas.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <algorithm>
#include <filesystem>

namespace stipple {
namespace {

constexpr int kDpi = 72;  // sizes are pixels

struct Font {
  const char* regular;
  const char* bold;
};
/// The first that is there; else VTK's own.
constexpr Font kFonts[] = {{"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                            "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf"},
                           {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                            "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"}};

const Font* InstalledFont() {
  static const Font* const kFont = [] {
    const Font* found = nullptr;
    std::error_code error;
    for (const Font& font : kFonts)
      if (found == nullptr && std::filesystem::exists(font.regular, error) &&
          std::filesystem::exists(font.bold, error))
        found = &font;
    return found;
  }();
  return kFont;
}

}  // namespace

TextAtlas::TextAtlas()
    : texels_(static_cast<std::size_t>(kWidth) * kHeight),
      property_(vtkSmartPointer<vtkTextProperty>::New()) {
  property_->SetColor(1, 1, 1);
}

TextAtlas::~TextAtlas() = default;

TextAtlas::Rendered TextAtlas::Render(const std::string& text, int size, bool bold) {
  property_->SetFontSize(size);
  if (const Font* font = InstalledFont()) {
    property_->SetFontFamily(VTK_FONT_FILE);
    property_->SetFontFile(bold ? font->bold : font->regular);
  } else {
    property_->SetFontFamilyToArial();
    property_->SetBold(bold);
  }
  vtkNew<vtkImageData> image;
  int dimensions[2] = {0, 0};
  Rendered rendered;
  if (!vtkTextRenderer::GetInstance()->RenderString(property_, vtkStdString(text), image,
                                                    dimensions, kDpi, vtkTextRenderer::FreeType))
    return rendered;
  int extent[6];
  image->GetExtent(extent);
  const int components = image->GetNumberOfScalarComponents();
  rendered.width = std::min(dimensions[0], extent[1] - extent[0] + 1);
  rendered.height = std::min(dimensions[1], extent[3] - extent[2] + 1);
  if (rendered.width <= 0 || rendered.height <= 0) return {};
  rendered.texels.resize(static_cast<std::size_t>(rendered.width) *
                         static_cast<std::size_t>(rendered.height));
  std::size_t at = 0;
  for (int y = rendered.height - 1; y >= 0; --y)  // VTK's rows go upwards
    for (int x = 0; x < rendered.width; ++x)
      rendered.texels[at++] = static_cast<const std::uint8_t*>(
          image->GetScalarPointer(extent[0] + x, extent[2] + y, 0))[components - 1];
  return rendered;
}

float TextAtlas::BaselineOf(int size, bool bold) {
  const auto [found, fresh] = baselines_.try_emplace({size, bold}, static_cast<float>(size));
  if (!fresh) return found->second;
  const Rendered letter = Render("H", size, bold);
  for (int y = 0; y < letter.height; ++y)
    for (int x = 0; x < letter.width; ++x)
      if (letter.texels[static_cast<std::size_t>(y * letter.width + x)] > 127)
        found->second = static_cast<float>(y + 1);
  return found->second;
}

bool TextAtlas::Place(const Rendered& rendered, PlacedText& placed) {
  if (rendered.width > kWidth) return false;
  if (x_ + rendered.width + 1 > kWidth) {
    x_ = 0;
    y_ += row_height_ + 1;
    row_height_ = 0;
  }
  if (y_ + rendered.height > kHeight) return false;
  for (int y = 0; y < rendered.height; ++y)
    std::copy_n(rendered.texels.begin() + y * rendered.width, rendered.width,
                texels_.begin() + (y_ + y) * kWidth + x_);
  placed.left = static_cast<float>(x_);
  placed.top = static_cast<float>(y_);
  if (first_changed_ == last_changed_) first_changed_ = y_;
  first_changed_ = std::min(first_changed_, y_);
  last_changed_ = std::max(last_changed_, y_ + rendered.height);
  x_ += rendered.width + 1;
  row_height_ = std::max(row_height_, rendered.height);
  return true;
}

PlacedText TextAtlas::Of(const std::string& text, int size, bool bold) {
  const auto [found, fresh] = placed_.try_emplace({text, size, bold});
  PlacedText& placed = found->second;
  if (!fresh) return placed;
  const Rendered rendered = Render(text, size, bold);
  if (rendered.width == 0) return placed;
  placed.width = static_cast<float>(rendered.width);
  placed.height = static_cast<float>(rendered.height);
  placed.baseline = BaselineOf(size, bold);
  if (!Place(rendered, placed)) {
    full_ = full_ || rendered.width <= kWidth;
    placed = {};
  }
  return placed;
}

std::pair<int, int> TextAtlas::TakeChangedRows() {
  const std::pair<int, int> changed(first_changed_, last_changed_);
  first_changed_ = last_changed_ = 0;
  return changed;
}

void TextAtlas::Clear() {
  placed_.clear();
  std::ranges::fill(texels_, std::uint8_t{0});
  x_ = y_ = row_height_ = 0;
  first_changed_ = 0;
  last_changed_ = kHeight;
  full_ = false;
  ++generation_;
}

}  // namespace stipple
