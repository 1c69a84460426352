// SPDX-License-Identifier: MIT
// Off means: every id slot is 0, as for a function that is filtered, so that a visit costs what it
// costs without a runtime. The exits of visits that were entered before have their tokens and are
// still recorded. Names go on being defined.
#include "runtime/core/switch.h"

#include <signal.h>

#include "runtime/core/clock.h"
#include "runtime/core/recorder.h"
#include "runtime/core/region.h"

namespace stipple {

constinit std::atomic<bool> switched_on{true};

namespace {

void Switch(Process& process, bool on) {
  if (process.state.load(std::memory_order_relaxed) != State::kRecording || on == IsSwitchedOn())
    return;
  // Noted before the first event and behind the last enter.
  if (on) DefineSwitch(process, true, 0);
  switched_on.store(on, std::memory_order_relaxed);
  UpdateAll();
  if (!on) DefineSwitch(process, false, 0);
}

void Toggle(int) {
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return;
  Holding holding(process->lock);
  Switch(*process, !IsSwitchedOn());
}

}  // namespace

void BeginPaused() {
  switched_on.store(false, std::memory_order_relaxed);
  struct sigaction now {};
  if (sigaction(SIGUSR2, nullptr, &now) != 0) return;
  if (now.sa_handler != SIG_DFL && now.sa_handler != SIG_IGN) return;
  struct sigaction toggle {};
  toggle.sa_handler = Toggle;
  toggle.sa_flags = SA_RESTART | SA_ONSTACK;
  sigaction(SIGUSR2, &toggle, nullptr);
}

void DefineSwitch(Process& process, bool on, std::uint32_t region) {
  Switched record{};
  record.ticks = ReadTicks();
  record.on = on ? 1 : 0;
  record.region = region;
  Define(process, &record, Switched::kKind, sizeof record);
}

void DefineSwitches(Process& process) {
  if (!IsSwitchedOn()) DefineSwitch(process, false, 0);
  DefineRegionSwitches(process);
}

}  // namespace stipple

extern "C" void stipple_switch(int on) {
  const stipple::SignalBlock signals_blocked;
  stipple::Process* process = stipple::BeginProcess();
  if (process == nullptr) return;
  stipple::Holding holding(process->lock);
  stipple::Switch(*process, on != 0);
}
