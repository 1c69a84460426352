// SPDX-License-Identifier: MIT
// The Neutral File Format (Eric Haines, 1987): the whole of it, read by tokens, so that line breaks
// mean nothing.
//
// clang-format off
//   # comment                                to the end of the line
//   v from x y z at x y z up x y z angle degrees hither d resolution w h
//                                            view; its parts in any order, hither may miss
//   b r g b                                  background
//   l x y z [r g b [radius]]                 light
//   f r g b Kd Ks shine T refraction [priority]
//                                            fill for the objects that follow; before the first: plain white
//   s x y z radius                           sphere
//   c base-x y z radius  apex-x y z radius   cone or cylinder, without ends
//   p n  x y z ...                           polygon, convex or not
//   pp n  x y z nx ny nz ...                 polygon with a normal at each vertex
//   bezier  x y z ...                        bicubic Bezier patch of 16 control points
// clang-format on
//
// Extensions, written only where a scene has them: `radius` of a light, `priority` of a fill,
// `bezier`. What cannot be drawn is refused (check.h), never dropped.
#ifndef STIPPLE_RAYTRACER_SCENE_NFF_H
#define STIPPLE_RAYTRACER_SCENE_NFF_H

#include <string>
#include <string_view>

#include "raytracer/geometry/shape_stream.h"
#include "raytracer/scene/file_bytes.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

/// Errors: InputError with the line of the token that is wrong.
Scene ReadNff(const std::string& path);

/// Objects go to `take` while they are read; what it leaves is in the scene. `name`, as below.
Scene ReadNff(Text& text, std::string_view name, const TakeShapes& take);

/// `name` stands in messages where a file's name would.
Scene ParseNff(std::string_view text, std::string_view name);

/// Only the view of a file, which may hold nothing else; what follows the view is not read.
View ReadNffView(const std::string& path);

/// Writes every number with as many digits as it takes to read the same number again.
/// Errors: InputError if the file cannot be written.
void WriteNff(const Scene& scene, const std::string& path);

/// The text that WriteNff writes.
std::string FormatNff(const Scene& scene);

}  // namespace stipple::raytracer

#endif
