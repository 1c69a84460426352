// SPDX-License-Identifier: MIT
#include "analysis/views/window/window.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/views/window/window_canvas.h"

namespace stipple {
namespace {

constexpr int kWidth = 1440, kHeight = 960;
constexpr unsigned long kSoon_ms = 1;    // after the events that wait already
constexpr unsigned long kRest_ms = 140;  // without motion: time for a fine picture
constexpr unsigned long kFrame_ms = 16;  // while playing
constexpr unsigned long kLook_ms = 50;   // for slow answers

using SteadyTime = std::chrono::steady_clock::time_point;

/// What takes long is asked for by a thread of its own.
class SlowAnswers {
 public:
  explicit SlowAnswers(const WindowSource& source) : worker_([this, &source] { Ask(source); }) {}

  bool done() const { return done_; }
  /// Hands what has come to the scene; true: something has.
  bool HandTo(WindowScene& scene) {
    const std::lock_guard lock(mutex_);
    const bool any = finding_ || tables_;
    if (finding_) scene.SetFinding(std::move(*finding_));
    if (tables_) scene.SetTables(std::move(*tables_));
    finding_.reset();
    tables_.reset();
    return any;
  }

 private:
  void Ask(const WindowSource& source) {
    try {
      DisplayTables tables = AskTables(source);
      Put(tables_, std::move(tables));
      Finding finding = source.FindFinding();
      Put(finding_, std::move(finding));
    } catch (const std::exception& problem) {
      Finding finding;
      finding.sentence = problem.what();
      Put(finding_, std::move(finding));
    }
    done_ = true;
  }
  template <class Answer>
  void Put(std::optional<Answer>& place, Answer answer) {
    const std::lock_guard lock(mutex_);
    place = std::move(answer);
  }

  std::mutex mutex_;
  std::optional<Finding> finding_;
  std::optional<DisplayTables> tables_;
  std::atomic<bool> done_ = false;
  std::jthread worker_;  // last: it uses all others
};

class Window {
 public:
  Window(const WindowSource& source, const WindowOptions& options)
      : canvas_(source, options.ranks, kWidth, kHeight), slow_(source) {
    canvas_.controller().mono = options.mono;
    interactor_->SetRenderWindow(canvas_.window());
    interactor_->SetInteractorStyle(nullptr);
    interactor_->EnableRenderOff();  // the canvas paints
  }

  void Run() {
    interactor_->Initialize();
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(this);
    observer->SetCallback([](vtkObject*, unsigned long event, void* self, void* data) {
      static_cast<Window*>(self)->On(event, data);
    });
    for (const unsigned long event :
         {vtkCommand::LeftButtonPressEvent, vtkCommand::LeftButtonReleaseEvent,
          vtkCommand::MiddleButtonPressEvent, vtkCommand::MiddleButtonReleaseEvent,
          vtkCommand::RightButtonPressEvent, vtkCommand::RightButtonReleaseEvent,
          vtkCommand::MouseMoveEvent, vtkCommand::MouseWheelForwardEvent,
          vtkCommand::MouseWheelBackwardEvent, vtkCommand::KeyPressEvent, vtkCommand::TimerEvent,
          vtkCommand::ConfigureEvent, vtkCommand::ExposeEvent})
      interactor_->AddObserver(event, observer);
    canvas_.Render();
    look_timer_ = interactor_->CreateOneShotTimer(kLook_ms);
    interactor_->Start();
    interactor_->RemoveObserver(observer);
    if (slow_.done()) return;
    // Nobody waits for the answers any more, and they cannot be called off.
    std::fflush(nullptr);
    std::_Exit(0);
  }

 private:
  Point Pointer() {
    const int* at = interactor_->GetEventPosition();
    return {static_cast<double>(at[0]),
            static_cast<double>(canvas_.window()->GetSize()[1] - 1 - at[1])};
  }
  void On(unsigned long event, void* data) {
    Controller& controller = canvas_.controller();
    const bool shift = interactor_->GetShiftKey() != 0;
    switch (event) {
      case vtkCommand::LeftButtonPressEvent:
        controller.Press(Button::kLeft, Pointer(), shift);
        break;
      case vtkCommand::MiddleButtonPressEvent:
      case vtkCommand::RightButtonPressEvent:
        controller.Press(Button::kOther, Pointer(), shift);
        break;
      case vtkCommand::LeftButtonReleaseEvent:
      case vtkCommand::MiddleButtonReleaseEvent:
      case vtkCommand::RightButtonReleaseEvent:
        controller.Release(Pointer());
        break;
      case vtkCommand::MouseMoveEvent:
        if (!controller.dragging()) return;
        controller.Move(Pointer());
        break;
      case vtkCommand::MouseWheelForwardEvent:
        controller.Wheel(Pointer(), 1);
        break;
      case vtkCommand::MouseWheelBackwardEvent:
        controller.Wheel(Pointer(), -1);
        break;
      case vtkCommand::KeyPressEvent:
        OnKey();
        break;
      case vtkCommand::TimerEvent:
        OnTimer(*static_cast<int*>(data));
        return;
      case vtkCommand::ExposeEvent:
        canvas_.Uncovered();
        break;
      default:
        break;
    }
    DrawSoon();
  }
  void OnKey() {
    const char* key = interactor_->GetKeySym();
    if (key == nullptr) return;
    const bool played = canvas_.state().playing();
    canvas_.controller().Key(key, interactor_->GetKeyCode(), interactor_->GetAltKey() != 0);
    if (!played) played_until_ = std::chrono::steady_clock::now();
    if (canvas_.state().quit) interactor_->TerminateApp();
  }
  void DrawSoon() {
    if (draw_timer_ == 0) draw_timer_ = interactor_->CreateOneShotTimer(kSoon_ms);
  }
  void OnTimer(int timer) {
    if (timer == look_timer_) {
      look_timer_ = slow_.done() ? 0 : interactor_->CreateOneShotTimer(kLook_ms);
      if (slow_.HandTo(canvas_.scene())) Draw();
    } else if (timer == draw_timer_) {
      draw_timer_ = 0;
      Draw();
    } else if (timer == rest_timer_) {
      rest_timer_ = 0;
      canvas_.controller().Rest();
      Draw();
    }
  }
  void Draw() {
    ViewState& state = canvas_.state();
    if (state.playing()) {
      const SteadyTime now = std::chrono::steady_clock::now();
      state.Advance(std::chrono::duration<double>(now - played_until_).count());
      played_until_ = now;
      if (draw_timer_ == 0) draw_timer_ = interactor_->CreateOneShotTimer(kFrame_ms);
    }
    canvas_.Render();
    if (!canvas_.controller().moving()) return;
    if (rest_timer_ != 0) interactor_->DestroyTimer(rest_timer_);
    rest_timer_ = interactor_->CreateOneShotTimer(kRest_ms);
  }

  WindowCanvas canvas_;
  vtkNew<vtkRenderWindowInteractor> interactor_;
  SlowAnswers slow_;
  SteadyTime played_until_{};
  int draw_timer_ = 0, rest_timer_ = 0, look_timer_ = 0;
};

}  // namespace

void ShowWindow(const WindowSource& source, const WindowOptions& options) {
  Window(source, options).Run();
}

}  // namespace stipple
