// SPDX-License-Identifier: MIT
#include "analysis/report/recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace stipple {

std::string Recorded::Reason() const { return error == 0 ? "" : std::strerror(error); }

std::vector<Recorded> RecordedOf(const Trace& trace) {
  std::vector<Recorded> all;
  for (const Process& p : trace.processes()) {
    for (const AvailabilityDefinition& a : p.stream->availability) {
      const auto known = std::ranges::find(all, a.what, &Recorded::what);
      if (known == all.end())
        all.push_back({std::string(a.what), a.available, a.error});
      else if (!a.available && known->available)
        *known = {known->what, false, a.error};
    }
  }
  return all;
}

std::string RecordedText(const Trace& trace) {
  std::string yes;
  std::string no;
  for (const Recorded& r : RecordedOf(trace)) {
    std::string& text = r.available ? yes : no;
    text += (text.empty() ? "" : ", ") + r.what;
    if (!r.available && r.error != 0) text += fmt::format(" ({})", r.Reason());
  }
  if (no.empty()) return yes;
  return yes.empty() ? "not " + no : yes + "; not " + no;
}

std::vector<std::string> NotRecordedTexts(const Trace& trace) {
  // Hardware counters come with the switches where there are some: their absence is no loss.
  constexpr std::array<std::string_view, 4> kAskedFor = {"switches", "switches of every thread",
                                                         "system calls", "all system calls"};
  std::vector<std::string> texts;
  for (const Recorded& r : RecordedOf(trace)) {
    if (r.available || std::ranges::find(kAskedFor, r.what) == kAskedFor.end()) continue;
    texts.push_back(
        fmt::format("{} could not be recorded{}", r.what, r.error == 0 ? "" : ": " + r.Reason()));
  }
  return texts;
}

}  // namespace stipple
