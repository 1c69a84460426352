// SPDX-License-Identifier: MIT
// A scene in one number: every object, in order, to six significant digits as NFF files carry them.
#ifndef STIPPLE_TESTS_RAYTRACER_SCENE_DIGEST_H
#define STIPPLE_TESTS_RAYTRACER_SCENE_DIGEST_H

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "raytracer/scene/nff.h"

namespace stipple::raytracer {

/// FNV-1a over all words of the scene's NFF text from the first fill on. Numbers are rounded to six
/// digits, and those below 1e-9 are zero: what rounding leaves of a zero differs from machine to
/// machine.
inline std::uint64_t DigestOf(const Scene& scene) {
  const std::string text = FormatNff(scene);
  std::istringstream words(text.substr(text.find("\nf ")));
  std::uint64_t digest = 0xcbf29ce484222325;
  for (std::string word; words >> word;) {
    if (word.find_first_of("0123456789") != std::string::npos) {
      const double value = std::stod(word);
      word = std::abs(value) < 1e-9 ? "0" : fmt::format("{:.6g}", value);
    }
    for (const char c : word + ' ')
      digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return digest;
}

}  // namespace stipple::raytracer

#endif
