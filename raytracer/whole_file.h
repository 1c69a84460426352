// SPDX-License-Identifier: MIT
// Files that are there whole or not at all.
#ifndef STIPPLE_RAYTRACER_WHOLE_FILE_H
#define STIPPLE_RAYTRACER_WHOLE_FILE_H

#include <functional>
#include <string>

namespace stipple::raytracer {

/// Lets `write` make a file of another name beside `path`, and then gives it its own: who is killed
/// meanwhile leaves what was there before, and PATH.unfinished. What is no plain file, such as a
/// pipe, or lies where nothing can be made, is written as it is. Errors: what `write` throws, and
/// InputError.
void WriteWhole(const std::string& path, const std::function<void(const std::string&)>& write);

}  // namespace stipple::raytracer

#endif
