// SPDX-License-Identifier: MIT
// How the ray tracer says no: unusable input and wrong options end the program with exit 2.
#ifndef STIPPLE_RAYTRACER_ERRORS_H
#define STIPPLE_RAYTRACER_ERRORS_H

#include <stdexcept>
#include <string_view>

namespace stipple::raytracer {

/// A file that cannot be used. Its message reads `file:line: problem`, without the line if that is
/// 0.
struct InputError : std::runtime_error {
  InputError(std::string_view file, long line, std::string_view problem);
};

/// An option or value that is not known or does not fit; the message names it and what is known.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A scene that does not fit into memory: there may be another way than giving up.
struct NoRoom : UsageError {
  using UsageError::UsageError;
};

}  // namespace stipple::raytracer

#endif
