// SPDX-License-Identifier: MIT
#include "raytracer/scene/shared_scene.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>

#include "raytracer/render/marks.h"
#include "raytracer/scene/memory_need.h"
#include "raytracer/scene/patches.h"
#include "raytracer/stopwatch.h"

namespace stipple::raytracer {
namespace {

/// What the leader tells the ranks that map the same file.
struct KeptPlace {
  char path[4096] = {};  // "": there is no file
  std::uint64_t hash = 0;
  View view;
};

/// What a node's leader knows on the way from a name to a model.
template <class Real>
class Leader {
 public:
  /// `allowed`: bytes that the scene may take.
  Leader(const SceneChoice& choice, Hierarchy hierarchy, std::uint64_t allowed)
      : choice_(choice), hierarchy_(hierarchy), allowed_(allowed) {}

  /// Finds the scene in the cache, or reads or generates it.
  void Load() {
    if (IsFile(choice_)) FindKept();
    if (!kept_) ReadScene();
    view_ = ViewOf(choice_, kept_ ? kept_->built.scene.view : scene_.view);
    found_ = kept_.has_value();
  }

  /// Builds the model if it was not found, and keeps a large one.
  void Build() {
    if (found_) return;  // a mapped file, which takes no memory that others need
    scene_.view = view_;
    const PatchChoice patches = ChoosePatches(scene_, choice_.patches);
    const auto cells = static_cast<std::uint64_t>(patches.cells);
    RequireMemory(
        BytesToBuild(scene_.shapes) + BytesOfTriangles(2 * cells * cells * patches.patches),
        allowed_, fmt::format("{} objects take", scene_.shapes.objects.size()));
    AdaptPatches(scene_, choice_.patches);
    Model<Real> model = BuildModel<Real>(std::move(scene_.shapes), hierarchy_);
    made_ = {std::move(scene_), std::move(model)};
    // What becomes of patches depends on the view, which the name of a kept scene does not tell.
    if (cache_ && made_.scene.patches.patches == 0) kept_ = cache_->Keep(made_);
  }

  const View& view() const { return view_; }

  KeptPlace place() const {
    KeptPlace place;
    place.view = view_;
    if (!kept_ || kept_->path.size() >= sizeof place.path) return place;
    kept_->path.copy(place.path, sizeof place.path - 1);
    place.hash = kept_->hash;
    return place;
  }

  BuiltScene<Real>& built() { return kept_ ? kept_->built : made_; }
  MappedFile TakeFile() { return kept_ ? std::move(kept_->file) : MappedFile(); }
  std::string FoundIn() const { return found_ ? kept_->path : ""; }

 private:
  /// In words, all that a model depends on beside its text.
  std::string Choices() const {
    return fmt::format("object-limit {} hierarchy {}", choice_.object_limit,
                       static_cast<int>(hierarchy_));
  }

  void FindKept() {
    const std::optional<Hash> text = Hash::OfFile(choice_.scene, kLeastCachedText);
    if (!text) return;
    std::string note;
    kept_ = SceneCache<Real>(*text, Choices()).Open(note);
    if (!note.empty()) fmt::print(stderr, "raytracer: {}\n", note);
  }

  /// The text is hashed again: somebody may have written to the file meanwhile.
  void ReadScene() {
    SceneStream stream(choice_);
    FittingShapes fitting(allowed_);
    if (!IsFile(choice_)) {
      // Generated in as much memory as it takes, and no more; so it is counted before.
      stream.Read([&](Shapes& added) { fitting.Count(added); });
      fitting.Require({});
      scene_ = stream.Read({});
      return;
    }
    scene_ = stream.Read([&](Shapes& added) { fitting.Take(added); });
    fitting.Require(scene_.shapes);
    if (stream.text_bytes() >= kLeastCachedText) cache_.emplace(stream.text_hash(), Choices());
  }

  const SceneChoice& choice_;
  Hierarchy hierarchy_;
  std::uint64_t allowed_;
  std::optional<SceneCache<Real>> cache_;
  std::optional<CachedScene<Real>> kept_;
  bool found_ = false;
  Scene scene_;
  View view_;
  BuiltScene<Real> made_;
};

template <class Real>
void Take(BuiltScene<Real>& built, SharedScene<Real>& to) {
  to.scene = std::move(built.scene);
  to.model = std::move(built.model);
}

template <class Real>
void TakeOwn(Leader<Real>& leader, SharedScene<Real>& to) {
  Take(leader.built(), to);
  to.scene.view = leader.view();
  to.file = leader.TakeFile();
}

/// All ranks of the node map the file that the leader's scene is kept in; false if one cannot.
template <class Real>
bool ShareFile(const Node& node, Leader<Real>& leader, const KeptPlace& place,
               SharedScene<Real>& shared) {
  if (place.path[0] == '\0') return false;
  std::optional<CachedScene<Real>> again;
  if (!node.leads()) again = OpenAgain<Real>(place.path, place.hash);
  if (!node.All(node.leads() || again.has_value())) return false;
  if (node.leads()) {
    TakeOwn(leader, shared);
  } else {
    Take(again->built, shared);
    shared.file = std::move(again->file);
  }
  return true;
}

/// The leader moves its scene into memory that all see; false if there is no room for that.
template <class Real>
bool ShareMemory(const Node& node, Leader<Real>& leader, SharedScene<Real>& shared) {
  BuiltScene<Real>& built = leader.built();
  shared.memory = NodeMemory(node, node.leads() ? HeaderOf(built).bytes : 0);
  const std::span<std::byte> block = shared.memory.block();
  if (block.empty()) return false;
  if (node.leads()) PackInto(block.data(), built);
  shared.memory.Publish();
  std::optional<BuiltScene<Real>> seen = Unpack<Real>(block);
  Take(node.leads() ? built : *seen, shared);
  return true;
}

template <class Real>
bool Share(const Node& node, Leader<Real>& leader, SharedScene<Real>& shared) {
  KeptPlace place;
  if (node.leads()) place = leader.place();
  MPI_Bcast(&place, sizeof place, MPI_BYTE, 0, node.comm());
  const bool done = ShareFile(node, leader, place, shared) || ShareMemory(node, leader, shared);
  shared.scene.view = place.view;
  return done;
}

}  // namespace

template <class Real>
SharedScene<Real> SceneForAll(const World& world, const SceneChoice& choice, Hierarchy hierarchy) {
  SharedScene<Real> shared;
  const Node node(world.comm);
  Leader<Real> leader(choice, hierarchy,
                      choice.memory_limit > 0 ? choice.memory_limit : AvailableBytes());
  Stopwatch watch;
  Mark(Moment::kLoadBegins);
  OnAllRanks(world, [&] { return node.leads() && (leader.Load(), true); });
  shared.load_s = watch.Lap();
  watch.LapCpu();
  Mark(Moment::kBuildBegins);
  OnAllRanks(world, [&] { return node.leads() && (leader.Build(), true); });
  const bool done = node.size() > 1 && Share(node, leader, shared);
  OnAllRanks(world, [&] {
    if (done) return true;
    // Alone on its node; or without room to share, and then each rank has a scene of its own.
    if (!node.leads()) leader.Load(), leader.Build();
    TakeOwn(leader, shared);
    return true;
  });
  shared.kept_in = leader.FoundIn();
  shared.build_s = watch.Lap();
  shared.build_cpu_s = watch.LapCpu();
  return shared;
}

template SharedScene<float> SceneForAll(const World&, const SceneChoice&, Hierarchy);
template SharedScene<double> SceneForAll(const World&, const SceneChoice&, Hierarchy);

}  // namespace stipple::raytracer
