// SPDX-License-Identifier: MIT
// One copy of a scene per node: the node's first rank loads and builds it, the others look at the
// same memory.
//
// That memory is a kept scene's mapped file (scene_cache.h) if there is one, else a window of MPI's
// shared memory; a rank that is alone on its node needs neither. Nothing travels between nodes: a
// file or a name is what all of them have.
#ifndef STIPPLE_RAYTRACER_SCENE_SHARED_SCENE_H
#define STIPPLE_RAYTRACER_SCENE_SHARED_SCENE_H

#include "raytracer/render/world.h"
#include "raytracer/scene/load.h"
#include "raytracer/scene/node_memory.h"
#include "raytracer/scene/packed_scene.h"
#include "raytracer/scene/scene_cache.h"

namespace stipple::raytracer {

template <class Real>
struct SharedScene {
  Scene scene;  // without shapes: they are in the model
  Model<Real> model;
  double load_s = 0, build_s = 0;  // of this rank, waiting for its leader included
  double build_cpu_s = 0;          // of all threads of this rank
  std::string kept_in;             // file that the scene was found in; empty if it was made

  // What the model may lie in.
  MappedFile file;
  NodeMemory memory;
};

/// The chosen scene, ready for tracing. Every rank calls it, and lets go of it before MPI_Finalize.
/// Errors: StoppedTogether.
template <class Real>
SharedScene<Real> SceneForAll(const World& world, const SceneChoice& choice, Hierarchy hierarchy);

}  // namespace stipple::raytracer

#endif
