// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_item.h"

#include <vtkContext2D.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLBufferObject.h>
#include <vtkOpenGLContextDevice2D.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkOpenGLVertexArrayObject.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtk_glew.h>

#include <cstddef>

namespace stipple {
namespace {

constexpr const char* kVertexShader = R"(//VTK::System::Dec
in vec2 place;
in vec3 kind;
in vec4 paint;
uniform vec2 size;
out vec3 kindOfPixel;
out vec4 paintOfPixel;
void main() {
  kindOfPixel = kind;
  paintOfPixel = paint;
  gl_Position = vec4(place.x * 2.0 / size.x - 1.0, 1.0 - place.y * 2.0 / size.y, 0.0, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec3 kindOfPixel;
in vec4 paintOfPixel;
uniform sampler2D atlas;
void main() {
  float alpha = paintOfPixel.a;
  if (kindOfPixel.z > 2.5) {
    float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 4.0);
    gl_FragData[0] = vec4(stripe < 2.0 ? paintOfPixel.rgb : vec3(1.0), alpha);
    return;
  }
  if (kindOfPixel.z > 1.5)
    alpha *= texelFetch(atlas, ivec2(kindOfPixel.xy), 0).r;
  else if (kindOfPixel.z > 0.5)
    alpha *= clamp(kindOfPixel.y + 0.5 - abs(kindOfPixel.x), 0.0, 1.0) *
             min(1.0, kindOfPixel.y * 2.0);
  gl_FragData[0] = vec4(paintOfPixel.rgb, alpha);
}
)";

}  // namespace

vtkStandardNewMacro(WindowItem);
WindowItem::WindowItem() = default;
WindowItem::~WindowItem() = default;

void WindowItem::Build(std::span<const ScenePart> parts, bool mono) {
  batches_.resize(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Batch& batch = batches_[i];
    if (batch.version == parts[i].version && mono == mono_) continue;
    batch.corners.clear();
    AppendLayer(parts[i].layer, mono, atlas_, batch.corners);
    batch.version = parts[i].version;
  }
  mono_ = mono;
}

void WindowItem::Show(std::span<const ScenePart> parts, bool mono) {
  Build(parts, mono);
  if (atlas_.full()) {
    atlas_.Clear();
    batches_.clear();
    Build(parts, mono);
  }
  corners_.clear();
  for (const Batch& batch : batches_)
    corners_.insert(corners_.end(), batch.corners.begin(), batch.corners.end());
}

void WindowItem::LoadAtlas(vtkOpenGLRenderWindow* window) {
  const auto [first, last] = atlas_.TakeChangedRows();
  const std::vector<std::uint8_t>& texels = atlas_.texels();
  if (!loaded_) {
    texture_->SetContext(window);
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

bool WindowItem::Paint(vtkContext2D* painter) {
  auto* device = vtkOpenGLContextDevice2D::SafeDownCast(painter->GetDevice());
  if (device == nullptr || corners_.empty()) return false;
  vtkOpenGLRenderWindow* window = device->GetRenderWindow();
  LoadAtlas(window);
  vtkOpenGLState* gl = window->GetState();
  gl->vtkglEnable(GL_BLEND);
  gl->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl->vtkglDisable(GL_DEPTH_TEST);
  gl->vtkglDisable(GL_CULL_FACE);
  vtkShaderProgram* program =
      window->GetShaderCache()->ReadyShaderProgram(kVertexShader, kFragmentShader, "");
  if (program == nullptr) return false;
  buffer_->Upload(corners_.data(), corners_.size(), vtkOpenGLBufferObject::ArrayBuffer);
  array_->Bind();
  const int stride = sizeof(Corner);
  array_->AddAttributeArray(program, buffer_, "place", 0, stride, VTK_FLOAT, 2, false);
  array_->AddAttributeArray(program, buffer_, "kind", offsetof(Corner, u), stride, VTK_FLOAT, 3,
                            false);
  array_->AddAttributeArray(program, buffer_, "paint", offsetof(Corner, red), stride,
                            VTK_UNSIGNED_CHAR, 4, true);
  const int* pixels = window->GetSize();
  const float size[2] = {static_cast<float>(pixels[0]), static_cast<float>(pixels[1])};
  program->SetUniform2f("size", size);
  texture_->Activate();
  program->SetUniformi("atlas", texture_->GetTextureUnit());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners_.size()));
  texture_->Deactivate();
  array_->Release();
  return true;
}

void WindowItem::ReleaseGraphicsResources() {
  buffer_->ReleaseGraphicsResources();
  array_->ReleaseGraphicsResources();
  texture_->ReleaseGraphicsResources(nullptr);
  loaded_ = false;
  vtkContextItem::ReleaseGraphicsResources();
}

}  // namespace stipple
