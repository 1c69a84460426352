// SPDX-License-Identifier: MIT
#include "analysis/tools/command.h"
namespace stipple {
int RunStats(const Arguments&) { return 2; }
int RunReport(const Arguments&) { return 2; }
}  // namespace stipple
