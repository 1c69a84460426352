// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_canvas.h"

#include <vtkContextActor.h>
#include <vtkContextScene.h>

#include <utility>

#include "analysis/views/window/facts.h"

namespace stipple {

WindowCanvas::WindowCanvas(const WindowSource& source, std::vector<int> ranks, int width,
                           int height)
    : source_(source),
      state_(source.EndSeconds(), source.Ranks()),
      scene_(source),
      controller_(source, state_, scene_),
      window_(vtkSmartPointer<vtkRenderWindow>::New()),
      renderer_(vtkSmartPointer<vtkRenderer>::New()) {
  state_.ShowRanks(std::move(ranks));
  window_->SetMultiSamples(0);  // edges are smooth without
  window_->SetSize(width, height);
  window_->AddRenderer(renderer_);
  renderer_->SetBackground(1, 1, 1);
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(item_);
  renderer_->AddActor(actor);
  title_ = TitleOf(state_, source_);
  window_->SetWindowName(title_.c_str());
}

WindowCanvas::~WindowCanvas() {
  // The item's buffers go while the context that they belong to is still there.
  item_->ReleaseGraphicsResources();
}

void WindowCanvas::Render() {
  const int* size = window_->GetSize();
  scene_.Resize(size[0], size[1]);
  item_->Show(scene_.Update(state_, controller_.moving(), controller_.band()), controller_.mono);
  window_->Render();
  // Behind the picture, so that whoever waits for the title finds it drawn.
  std::string title = TitleOf(state_, source_);
  if (title == title_) return;
  title_ = std::move(title);
  window_->SetWindowName(title_.c_str());
}

}  // namespace stipple
