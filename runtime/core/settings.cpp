// SPDX-License-Identifier: MIT
#include "runtime/core/settings.h"

#include <stdlib.h>

#include "runtime/core/line.h"

namespace stipple {
namespace {

constinit Settings settings{};
constinit bool was_read = false;

bool StartsWith(const char* text, const char* start) {
  while (*start != '\0')
    if (*text++ != *start++) return false;
  return true;
}

/// A copy, since the program may change its environment; null if it is not set or empty.
const char* CopyOfVariable(const char* name) {
  const char* value = getenv(name);
  if (value == nullptr || *value == '\0') return nullptr;
  const std::size_t bytes = TextBytes(value) + 1;
  char* copy = static_cast<char*>(MapMemory(bytes));
  if (copy != nullptr) CopyBytes(copy, value, bytes);
  return copy;
}

/// The N of "sparse:N", a power of two from 1 to 4096; 0 if it is none.
std::uint64_t SparseDistance(const char* text) {
  if (!StartsWith(text, "sparse:")) return 0;
  std::uint64_t distance = 0;
  for (text += 7; *text >= '0' && *text <= '9' && distance <= 4096; ++text)
    distance = distance * 10 + static_cast<std::uint64_t>(*text - '0');
  const bool power_of_two = distance != 0 && (distance & (distance - 1)) == 0;
  return *text == '\0' && power_of_two && distance <= 4096 ? distance : 0;
}

/// The P of "budget:P", percent above 0 and up to 100, as a share; 0 if it is none.
double BudgetShare(const char* text) {
  if (!StartsWith(text, "budget:")) return 0;
  double percent = 0, unit = 1;
  bool fraction = false, digits = false;
  for (text += 7; *text != '\0' && *text != '%'; ++text) {
    if (*text == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (*text < '0' || *text > '9') return 0;
    digits = true;
    percent = 10 * percent + (*text - '0');
    if (fraction) unit *= 10;
  }
  if (*text == '%') ++text;
  percent /= unit;
  return *text == '\0' && digits && percent <= 100 ? percent / 100 : 0;
}

void ReadClockSetting() {
  const char* clock = getenv("STIPPLE_CLOCK");
  if (clock == nullptr || *clock == '\0') clock = "budget:5";
  std::uint64_t distance = SparseDistance(clock);
  settings.budget = BudgetShare(clock);
  const bool exact = StartsWith(clock, "exact") && clock[5] == '\0';
  if (distance == 0 && settings.budget == 0 && !exact) {
    Line<256> line;
    line.Add("stipple: clock '").Add(clock);
    line.Add("' is unknown (exact, sparse:N, budget:P); using exact\n");
    line.Print();
    clock = "exact";
  }
  if (distance == 0) distance = 1;
  settings.clock_mask = (distance - 1) * 8;
  Line<sizeof settings.text> text;
  text.Add("clock=").Add(clock);
  CopyBytes(settings.text, text.text(), text.length());
}

}  // namespace

const Settings& ReadSettings() {
  if (was_read) return settings;
  settings.archive = CopyOfVariable("STIPPLE_ARCHIVE");
  if (settings.archive != nullptr) {
    ReadClockSetting();
    settings.filter = CopyOfVariable("STIPPLE_FILTER");
    const char* paused = getenv("STIPPLE_PAUSED");
    settings.paused = paused != nullptr && *paused != '\0';
  }
  was_read = true;
  return settings;
}

}  // namespace stipple
