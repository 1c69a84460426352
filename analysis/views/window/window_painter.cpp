// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_painter.h"

#include <vtkOpenGLBufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkOpenGLVertexArrayObject.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtk_glew.h>

#include <algorithm>
#include <cstddef>

#include "analysis/views/window/shown_part.h"

namespace stipple {
namespace {

// In software each pixel pays for all that its program could do, so plain fills, which are most of
// them, have one of their own.
constexpr const char* kFillVertexShader = R"(//VTK::System::Dec
in vec2 place;
in vec4 paint;
uniform vec2 size;
flat out vec4 paintOfPixel;
void main() {
  paintOfPixel = paint;
  gl_Position = vec4(place.x * 2.0 / size.x - 1.0, 1.0 - place.y * 2.0 / size.y, 0.0, 1.0);
}
)";

constexpr const char* kFillFragmentShader = R"(//VTK::System::Dec
//VTK::Output::Dec
flat in vec4 paintOfPixel;
void main() { gl_FragData[0] = paintOfPixel; }
)";

constexpr const char* kInkVertexShader = R"(//VTK::System::Dec
in vec2 place;
in vec3 kind;
in vec4 paint;
uniform vec2 size;
out vec2 placeOfPixel;
flat out float inkOfPixel;
flat out vec4 paintOfPixel;
void main() {
  placeOfPixel = kind.xy;
  inkOfPixel = kind.z;
  paintOfPixel = paint;
  gl_Position = vec4(place.x * 2.0 / size.x - 1.0, 1.0 - place.y * 2.0 / size.y, 0.0, 1.0);
}
)";

constexpr const char* kInkFragmentShader = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec2 placeOfPixel;
flat in float inkOfPixel;
flat in vec4 paintOfPixel;
uniform sampler2D atlas;
void main() {
  float alpha = paintOfPixel.a;
  if (inkOfPixel > 2.5) {
    float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 4.0);
    gl_FragData[0] = vec4(stripe < 2.0 ? paintOfPixel.rgb : vec3(1.0), alpha);
    return;
  }
  if (inkOfPixel > 1.5)
    alpha *= texelFetch(atlas, ivec2(placeOfPixel), 0).r;
  else
    alpha *= clamp(placeOfPixel.y + 0.5 - abs(placeOfPixel.x), 0.0, 1.0) *
             min(1.0, placeOfPixel.y * 2.0);
  gl_FragData[0] = vec4(paintOfPixel.rgb, alpha);
}
)";

bool IsFill(const Corner& corner) { return corner.ink == static_cast<float>(Ink::kFill); }

}  // namespace

WindowPainter::WindowPainter() = default;
WindowPainter::~WindowPainter() = default;

void WindowPainter::Build(std::span<const ScenePart> parts, bool mono) {
  batches_.resize(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Batch& batch = batches_[i];
    if (batch.version == parts[i].version && mono == mono_) continue;
    std::vector<Corner> corners;
    corners.reserve(batch.corners.size());
    AppendLayer(parts[i].layer, mono, atlas_, corners);
    AddChange(changed_, batch.corners, corners);
    batch = {parts[i].version, std::move(corners), {}};
    batch.box = BoxOf(batch.corners);
  }
  mono_ = mono;
}

void WindowPainter::Show(std::span<const ScenePart> parts, bool mono) {
  Build(parts, mono);
  if (!atlas_.full()) return;
  atlas_.Clear();
  batches_.clear();
  PaintAll();
  Build(parts, mono);
}

void WindowPainter::LoadAtlas(vtkOpenGLRenderWindow& window) {
  const auto [first, last] = atlas_.TakeChangedRows();
  const std::vector<std::uint8_t>& texels = atlas_.texels();
  if (!loaded_) {
    texture_->SetContext(&window);
    texture_->SetMinificationFilter(vtkTextureObject::Nearest);
    texture_->SetMagnificationFilter(vtkTextureObject::Nearest);
    std::vector<std::uint8_t> copy = texels;  // VTK asks for bytes that it might change
    texture_->Create2DFromRaw(TextAtlas::kWidth, TextAtlas::kHeight, 1, VTK_UNSIGNED_CHAR,
                              copy.data());
    loaded_ = true;
  } else if (first < last) {
    texture_->Activate();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, first, TextAtlas::kWidth, last - first, GL_RED,
                    GL_UNSIGNED_BYTE,
                    texels.data() + static_cast<std::ptrdiff_t>(first) * TextAtlas::kWidth);
    texture_->Deactivate();
  }
}

/// Appends the triangles that meet the box to those that are to be painted.
std::vector<WindowPainter::Run> WindowPainter::RunsIn(const PixelBox& box) {
  std::vector<Run> runs;
  for (const Batch& batch : batches_) {
    if (!batch.box.Meets(box)) continue;
    for (std::size_t i = 0; i + 3 <= batch.corners.size(); i += 3) {
      const std::span<const Corner> triangle(&batch.corners[i], 3);
      if (!BoxOf(triangle).Meets(box)) continue;
      const bool fill = IsFill(triangle[0]);
      if (runs.empty() || runs.back().fill != fill) runs.push_back({corners_.size(), 0, fill});
      runs.back().count += 3;
      corners_.insert(corners_.end(), triangle.begin(), triangle.end());
    }
  }
  return runs;
}

/// Corners and programs become the ones that Draw uses.
void WindowPainter::Load(vtkOpenGLRenderWindow& window) {
  LoadAtlas(window);
  buffer_->Upload(corners_.data(), corners_.size(), vtkOpenGLBufferObject::ArrayBuffer);
  vtkOpenGLShaderCache* cache = window.GetShaderCache();
  const int stride = sizeof(Corner);
  const float size[2] = {static_cast<float>(width_), static_cast<float>(height_)};
  const auto ready = [&](vtkShaderProgram* program, vtkOpenGLVertexArrayObject* array) {
    array->Bind();
    array->AddAttributeArray(program, buffer_, "place", 0, stride, VTK_FLOAT, 2, false);
    array->AddAttributeArray(program, buffer_, "paint", offsetof(Corner, red), stride,
                             VTK_UNSIGNED_CHAR, 4, true);
    program->SetUniform2f("size", size);
  };
  fill_ = cache->ReadyShaderProgram(kFillVertexShader, kFillFragmentShader, "");
  if (fill_ != nullptr) ready(fill_, fill_array_);
  ink_ = cache->ReadyShaderProgram(kInkVertexShader, kInkFragmentShader, "");
  if (ink_ == nullptr) return;
  ready(ink_, ink_array_);
  ink_array_->AddAttributeArray(ink_, buffer_, "kind", offsetof(Corner, u), stride, VTK_FLOAT, 3,
                                false);
  ink_->SetUniformi("atlas", texture_->GetTextureUnit());
}

void WindowPainter::Draw(vtkOpenGLRenderWindow& window, const Run& run) {
  vtkShaderProgram* program = run.fill ? fill_ : ink_;
  if (program == nullptr) return;
  vtkOpenGLState* gl = window.GetState();
  if (run.fill)
    gl->vtkglDisable(GL_BLEND);
  else
    gl->vtkglEnable(GL_BLEND);
  window.GetShaderCache()->ReadyShaderProgram(program);
  (run.fill ? fill_array_ : ink_array_)->Bind();
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(run.first), static_cast<GLsizei>(run.count));
}

void WindowPainter::Paint(vtkOpenGLRenderWindow& window) {
  window.MakeCurrent();
  const int* size = window.GetSize();
  const PixelBox whole{0, 0, size[0], size[1]};
  if (width_ != size[0] || height_ != size[1] || !CanShowParts(window)) changed_ = {whole};
  width_ = size[0];
  height_ = size[1];
  if (changed_.empty()) return;
  std::vector<std::vector<Run>> runs;
  corners_.clear();
  for (PixelBox& box : changed_) {
    box = {std::max(box.left, 0), std::max(box.top, 0), std::min(box.right, width_),
           std::min(box.bottom, height_)};
    runs.push_back(RunsIn(box));
  }
  vtkOpenGLState* gl = window.GetState();
  gl->vtkglBindFramebuffer(GL_FRAMEBUFFER, 0);
  gl->vtkglDrawBuffer(GL_BACK);
  gl->vtkglViewport(0, 0, width_, height_);
  gl->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl->vtkglDisable(GL_DEPTH_TEST);
  gl->vtkglDisable(GL_CULL_FACE);
  gl->vtkglEnable(GL_SCISSOR_TEST);
  gl->vtkglClearColor(1, 1, 1, 1);
  if (!corners_.empty()) Load(window);
  texture_->Activate();
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    const PixelBox& box = changed_[i];
    if (box.empty()) continue;
    gl->vtkglScissor(box.left, height_ - box.bottom, box.right - box.left, box.bottom - box.top);
    gl->vtkglClear(GL_COLOR_BUFFER_BIT);
    for (const Run& run : runs[i]) Draw(window, run);
  }
  texture_->Deactivate();
  ink_array_->Release();
  gl->vtkglDisable(GL_SCISSOR_TEST);
  ShowParts(window, changed_);
  changed_.clear();
}

void WindowPainter::ReleaseGraphicsResources() {
  buffer_->ReleaseGraphicsResources();
  fill_array_->ReleaseGraphicsResources();
  ink_array_->ReleaseGraphicsResources();
  texture_->ReleaseGraphicsResources(nullptr);
  loaded_ = false;
}

}  // namespace stipple
