// SPDX-License-Identifier: MIT
// stipple view: reads the archive and answers the window's questions; the library that draws it is
// opened only here.
#include <array>
#include <memory>

#include "analysis/report/window_door.h"
#include "analysis/stats/analysis.h"
#include "analysis/stats/window_source.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/tools/views_library.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

constexpr const char* kCommand = "stipple view";

template <class Function>
Function FunctionOfWindow(const char* name) {
  return reinterpret_cast<Function>(FunctionOfLibrary(kCommand, "libstipple-window.so", name));
}

/// Before anything is read: whoever has no display need not wait to be told.
void NeedDisplay() {
  std::array<char, 1024> error{};
  if (FunctionOfWindow<decltype(&stipple_check_display)>("stipple_check_display")(
          error.data(), error.size()) != 0)
    throw InputError(kCommand, std::string(error.data()) + "; stipple report needs none");
}

}  // namespace

int RunView(const Arguments& arguments) {
  CommandOptions app("An interactive window: zoom to single events, click for facts, play in time.",
                     "view");
  std::string archive;
  std::string ranks;
  bool mono = false;
  app.Add({"A", "", "the archive", true}, archive);
  app.Add({"--ranks", "R", "show only these at first: 0-3,7,host"}, ranks);
  app.Add({"--mono", "", "patterns instead of colours"}, mono);
  if (!app.Parse(arguments)) return 0;
  NeedDisplay();
  ProgressLine progress;
  const Trace trace = Trace::Open(archive, progress.meter());
  std::vector<int> shown;
  if (!ranks.empty()) shown = ParseRanks(trace, ranks);
  const Analysis analysis(trace);
  const std::unique_ptr<WindowSource> source = MakeWindowSource(analysis);
  progress.Stop();
  WarnOfProblems(trace, analysis.health);
  if (source->Ranks().empty()) throw InputError(archive, "holds no events to show");
  std::array<char, 1024> error{};
  const int failed = FunctionOfWindow<decltype(&stipple_show_window)>("stipple_show_window")(
      source.get(), shown.data(), shown.size(), mono, error.data(), error.size());
  if (failed != 0) throw InputError(kCommand, error.data());
  return 0;
}

}  // namespace stipple
