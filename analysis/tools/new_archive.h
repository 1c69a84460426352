// SPDX-License-Identifier: MIT
// The archive that a command makes by running a program.
#ifndef STIPPLE_ANALYSIS_TOOLS_NEW_ARCHIVE_H
#define STIPPLE_ANALYSIS_TOOLS_NEW_ARCHIVE_H

#include <string>

namespace stipple {

/// "A.stipple/" as "A.stipple".
std::string WithoutSlash(std::string path);

/// False if no archive can be written there: said in one line, and no reason not to run the
/// command.
bool MakeArchive(const std::string& path, bool overwrite);

/// Never fails: an archive that cannot be compacted is as good, only larger.
void CompactNew(const std::string& archive);

}  // namespace stipple

#endif
