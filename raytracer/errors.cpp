// SPDX-License-Identifier: MIT
#include "raytracer/errors.h"

#include <fmt/format.h>

namespace stipple::raytracer {

InputError::InputError(std::string_view file, long line, std::string_view problem)
    : std::runtime_error(line > 0 ? fmt::format("{}:{}: {}", file, line, problem)
                                  : fmt::format("{}: {}", file, problem)) {}

}  // namespace stipple::raytracer
