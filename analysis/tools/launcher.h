// SPDX-License-Identifier: MIT
// Commands that start other commands: which program is meant, and how the environment reaches it.
#ifndef STIPPLE_ANALYSIS_TOOLS_LAUNCHER_H
#define STIPPLE_ANALYSIS_TOOLS_LAUNCHER_H

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// Index of the program that a command is about: behind mpirun, srun, env and their options.
std::size_t ProgramIndex(const std::vector<std::string>& command);

/// Open MPI's launcher takes no variables to other computers unless told so (-x). Adds what is
/// needed, leaves alone what the user has said, and puts `preload` before the user's own
/// -x LD_PRELOAD=...; a command that does not begin with a launcher stays as it is.
/// `is_open_mpi`: of the launcher's name.
std::vector<std::string> WithExports(const std::vector<std::string>& command,
                                     const std::vector<std::string>& variables,
                                     std::string_view preload,
                                     const std::function<bool(const std::string&)>& is_open_mpi);

}  // namespace stipple

#endif
