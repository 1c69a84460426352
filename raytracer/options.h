// SPDX-License-Identifier: MIT
// What users type: one row per option. Parser, --help and the messages about unknown values derive
// from the rows.
#ifndef STIPPLE_RAYTRACER_OPTIONS_H
#define STIPPLE_RAYTRACER_OPTIONS_H

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "raytracer/render/sampling.h"
#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// Whole numbers and sizes that were not given are 0, files that were not given are empty.
struct Options {
  std::string scene = "balls";
  std::int64_t scene_size = -1;
  std::int64_t object_limit = 0;
  std::string camera = "default";
  ImageSize resolution;
  std::string partition = "scattered";
  std::string tile = "rows";
  std::int64_t bundle = 512;
  std::string select = "contiguous";
  std::int64_t seed = 1;
  std::string objects = "auto";
  double replicate = 0;
  std::int64_t package = 128;
  Samples samples;
  double tolerance = Samples{}.tolerance;
  std::int64_t max_depth = 5;
  double min_contribution = 0;
  std::string precision = "double";
  std::string kernel = "bvh";
  std::string patches = "auto";
  std::int64_t memory_limit = 0;
  std::string output;
  std::string cost_map;
  std::string stats;
  std::string write_scene;
  std::pair<std::string, std::string> compare;
  bool explain = false;
  bool help = false;
};

/// In `value`, words in small letters are choices; words with capitals stand for what the user
/// fills in. An option whose value has no capitals accepts nothing but its choices; one without a
/// value is a switch.
struct OptionSpec {
  std::string_view name;
  std::variant<std::string Options::*, std::int64_t Options::*, double Options::*, bool Options::*,
               ImageSize Options::*, Samples Options::*,
               std::pair<std::string, std::string> Options::*>
      member;
  std::string_view value;
  std::string_view meaning;
  double low = 0, high = 0;  // of a number
};

inline constexpr double kMostPoints = 1e9;

inline constexpr OptionSpec kOptions[] = {
    {"scene", &Options::scene, "balls|rings|teapot|teapot-patches|tree|FILE.nff", "what to render"},
    {"scene-size", &Options::scene_size, "N",
     "size of a generated scene (balls 4, rings 7, teapot and teapot-patches 12, tree 11)", 0,
     100000},
    {"object-limit", &Options::object_limit, "N",
     "keep only N objects: of balls the largest, else the first (all)", 1, kMostPoints},
    {"camera", &Options::camera, "default|side|above|FILE",
     "the scene's own view, teapot from the side, rings from above, or the view of an NFF file"},
    {"resolution", &Options::resolution, "WxH", "image size in pixels (the scene's)", 1, 16384},
    {"partition", &Options::partition, "tiled|scattered|bundles|guided",
     "who traces which ray: one tile per rank, row i by rank i mod P, bundles that a host (the "
     "last rank) hands out, or bundles that ranks take themselves, the dearest first"},
    {"tile", &Options::tile, "rows|columns|blocks", "shape of the tiles of --partition tiled"},
    {"bundle", &Options::bundle, "PIXELS", "size of the bundles of --partition bundles", 1,
     kMostPoints},
    {"select", &Options::select, "contiguous|modulo|random",
     "which pixels make a bundle: neighbours, every B-th of B bundles, or a random choice"},
    {"seed", &Options::seed, "N", "of the random choice", 0, 9e15},
    {"objects", &Options::objects, "auto|replicated|partitioned|coupled",
     "a copy of all objects on each node, objects divided among the ranks so that rays travel to "
     "them, divided but for those that a pilot finds dear, or a copy where it fits"},
    {"replicate", &Options::replicate, "F",
     "share of a divided scene that each rank holds (0: one part; coupled: what fits)", 0, 1},
    {"package", &Options::package, "RAYS", "of a divided scene: rays in a message, at most", 1,
     65536},
    {"samples", &Options::samples, "corners|N|adaptive",
     "rays per pixel: its four corners, shared with its neighbours, N inside, or from 8 to 256 as "
     "the pixel needs",
     1, 4096},
    {"tolerance", &Options::tolerance, "E",
     "of --samples adaptive: smaller means more rays where they lower the picture's error", 1e-6,
     1},
    {"max-depth", &Options::max_depth, "D", "rays to follow one after another; eye rays are 1", 1,
     64},
    {"min-contribution", &Options::min_contribution, "C",
     "do not trace rays whose share of an eye ray's colour is less (of 1)", 0, 1},
    {"precision", &Options::precision, "double|float", "kind of number that rays are computed in"},
    {"kernel", &Options::kernel, "bvh|scalar|embree",
     "what finds hits: the own hierarchy, the same without vector instructions, or Embree"},
    {"patches", &Options::patches, "auto|direct|N",
     "Bezier patches as N x N pairs of triangles, by direct intersection, or as the picture needs",
     1, 1024},
    {"memory-limit", &Options::memory_limit, "BYTES",
     "refuse a scene that takes more on a node; K, M, G and T are understood (what the node has)",
     1, 9e15},
    {"output", &Options::output, "F.png|F.exr",
     "write the picture, as 8-bit colours or as floating-point numbers"},
    {"cost-map", &Options::cost_map, "F.png|F.csv",
     "write what each pixel cost, as colours or as a table x,y,work,object,in_shadow,depth"},
    {"stats", &Options::stats, "F.json", "write counts and times"},
    {"write-scene", &Options::write_scene, "F.nff", "write the scene and stop"},
    {"explain", &Options::explain, "", "say what is adapted to this scene, and why"},
    {"compare", &Options::compare, "A.png B.png",
     "say how far two pictures (or .exr) differ and stop; exit status 0 if they are identical, "
     "else "
     "1; --output shows where"},
};

/// Errors: UsageError, naming the option or value and what is known.
Options ParseOptions(int argc, const char* const* argv);

/// Is the scene to be divided whatever its size?
inline bool IsDivided(const Options& options) {
  return options.objects == "partitioned" || options.objects == "coupled";
}

/// The text of --help.
std::string HelpText();

}  // namespace stipple::raytracer

#endif
