// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_canvas.h"

#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <utility>

#include "analysis/views/window/facts.h"
#include "analysis/views/window/window_item.h"

namespace stipple {

struct WindowCanvas::Vtk {
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<WindowItem> item;
};

WindowCanvas::WindowCanvas(const WindowSource& source, std::vector<int> ranks, int width,
                           int height)
    : source_(source),
      state_(source.EndSeconds(), source.Ranks()),
      scene_(source),
      controller_(source, state_, scene_),
      vtk_(std::make_unique<Vtk>()) {
  state_.ShowRanks(std::move(ranks));
  vtk_->window->SetMultiSamples(0);  // edges are smooth without
  vtk_->window->SetSize(width, height);
  vtk_->window->AddRenderer(vtk_->renderer);
  vtk_->renderer->SetBackground(1, 1, 1);
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(vtk_->item);
  vtk_->renderer->AddActor(actor);
  title_ = TitleOf(state_, source_);
  vtk_->window->SetWindowName(title_.c_str());
}

WindowCanvas::~WindowCanvas() {
  // The item's buffers go while the context that they belong to is still there.
  vtk_->item->ReleaseGraphicsResources();
}

void WindowCanvas::Render() {
  const int* size = vtk_->window->GetSize();
  scene_.Resize(size[0], size[1]);
  vtk_->item->Show(scene_.Update(state_, controller_.moving(), controller_.band()),
                   controller_.mono);
  vtk_->window->Render();
  // Behind the picture, so that whoever waits for the title finds it drawn.
  std::string title = TitleOf(state_, source_);
  if (title == title_) return;
  title_ = std::move(title);
  vtk_->window->SetWindowName(title_.c_str());
}

vtkRenderWindow* WindowCanvas::window() { return vtk_->window; }

std::size_t WindowCanvas::corner_count() const { return vtk_->item->corner_count(); }

}  // namespace stipple
