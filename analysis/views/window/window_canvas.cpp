// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_canvas.h"

#include <vtkOpenGLRenderWindow.h>
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include <utility>

#include "analysis/views/window/facts.h"
#include "analysis/views/window/window_painter.h"

namespace stipple {

struct WindowCanvas::Vtk {
  vtkSmartPointer<vtkRenderWindow> made = vtkSmartPointer<vtkRenderWindow>::New();
  vtkOpenGLRenderWindow* window = vtkOpenGLRenderWindow::SafeDownCast(made);
  WindowPainter painter;
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
  title_ = TitleOf(state_, source_);
  vtk_->window->SetWindowName(title_.c_str());
}

WindowCanvas::~WindowCanvas() {
  // The painter's buffers go while the context that they belong to is still there.
  vtk_->painter.ReleaseGraphicsResources();
}

void WindowCanvas::Render() {
  // Not before: an interactor that finds no connection to the X server opens one and keeps it until
  // its loop has ended.
  vtk_->window->Initialize();
  const int* size = vtk_->window->GetSize();
  scene_.Resize(size[0], size[1]);
  vtk_->painter.Show(scene_.Update(state_, controller_.moving(), controller_.band()),
                     controller_.mono);
  vtk_->painter.Paint(*vtk_->window);
  // Behind the picture, so that whoever waits for the title finds it drawn.
  std::string title = TitleOf(state_, source_);
  if (title == title_) return;
  title_ = std::move(title);
  vtk_->window->SetWindowName(title_.c_str());
}

void WindowCanvas::Uncovered() { vtk_->painter.PaintAll(); }

vtkRenderWindow* WindowCanvas::window() { return vtk_->window; }

}  // namespace stipple
