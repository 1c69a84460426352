// SPDX-License-Identifier: MIT
// Bundles on demand. A node asks by sending what it found; its first, empty message asks too. The
// host answers with the number of the next bundle, or kNoBundle when there is none left, before it
// looks at what came in: the node should not wait for the host's bookkeeping.
//
// It ends because each node sends exactly one message per bundle it was given and one more, and the
// host answers each one.
#include "raytracer/render/marks.h"
#include "raytracer/render/progress.h"
#include "raytracer/render/render.h"

namespace stipple::raytracer {
namespace {

constexpr int kResultTag = 2;
constexpr int kBundleTag = 3;
constexpr std::uint32_t kNoBundle = 0xffffffff;

[[gnu::noinline]] std::vector<RayResult> TraceBundle(Sampler& sampler,
                                                     const std::vector<RasterPoint>& points,
                                                     const Round& round) {
  std::vector<RayResult> results;
  results.reserve(points.size());
  for (const RasterPoint point : points) results.push_back(round.Trace(sampler, point));
  RecordCounts(sampler.counts());
  return results;
}

class Host {
 public:
  Host(const World& world, const PartitionChoice& choice, const Round& round)
      : world_(world),
        round_(round),
        bundles_(choice),
        given_(static_cast<std::size_t>(world.size - 1), kNoBundle),
        working_(world.size - 1),
        raster_(PointCount(choice.raster)),
        incoming_(choice.bundle < raster_.size() ? choice.bundle : raster_.size()) {}

  void Serve() {
    SkipEmpty();
    Progress progress(round_.Count(raster_.size()), true);
    while (working_ > 0) {
      MPI_Status status;
      MPI_Recv(incoming_.data(), static_cast<int>(incoming_.size()), type_.get(), MPI_ANY_SOURCE,
               kResultTag, world_.comm, &status);
      const std::uint32_t finished = HandOut(status.MPI_SOURCE);
      if (finished == kNoBundle) continue;
      const std::vector<RasterPoint> points = round_.Of(bundles_.Points(finished));
      Place(points, incoming_, raster_);
      progress.Advance(points.size());
    }
  }

  Raster TakeRaster() { return std::move(raster_); }
  std::uint64_t messages() const { return messages_; }

 private:
  /// Answers a node and returns the bundle it had.
  [[gnu::noinline]] std::uint32_t HandOut(int node) {
    std::uint32_t& given = given_[static_cast<std::size_t>(node)];
    const std::uint32_t finished = given;
    given = next_ < bundles_.count() ? next_++ : kNoBundle;
    SkipEmpty();
    MPI_Send(&given, 1, MPI_UINT32_T, node, kBundleTag, world_.comm);
    ++messages_;
    if (given == kNoBundle) {
      --working_;
    } else {
      RecordBundlesLeft(bundles_.count() - next_);
      if (next_ == bundles_.count()) Mark(Moment::kSupplyEnds);
    }
    return finished;
  }

  /// Bundles of which this round traces nothing are not handed out.
  void SkipEmpty() {
    while (next_ < bundles_.count() && round_.Of(bundles_.Points(next_)).empty()) ++next_;
  }

  const World& world_;
  const Round& round_;
  Bundles bundles_;
  std::uint32_t next_ = 0;
  std::vector<std::uint32_t> given_;  // by node: the bundle it is working on
  int working_;                       // nodes that have not been told to stop
  Raster raster_;
  std::vector<RayResult> incoming_;
  ResultType type_;
  std::uint64_t messages_ = 0;
};

[[gnu::noinline]] Rendered Serve(const World& world, const PartitionChoice& choice,
                                 const Round& round) {
  MarkHost();
  Host host(world, choice, round);
  host.Serve();
  Rendered rendered(host.TakeRaster());
  rendered.messages = host.messages();
  return rendered;
}

[[gnu::noinline]] std::uint64_t TraceOnDemand(const World& world, Sampler& sampler,
                                              const PartitionChoice& choice, const Round& round) {
  const Bundles bundles(choice);
  const ResultType type;
  const int host = world.size - 1;
  std::uint64_t messages = 0;
  std::vector<RayResult> results;
  while (true) {
    MPI_Send(results.data(), static_cast<int>(results.size()), type.get(), host, kResultTag,
             world.comm);
    ++messages;
    std::uint32_t bundle = kNoBundle;
    MPI_Recv(&bundle, 1, MPI_UINT32_T, host, kBundleTag, world.comm, MPI_STATUS_IGNORE);
    if (bundle == kNoBundle) return messages;
    results = TraceBundle(sampler, round.Of(bundles.Points(bundle)), round);
  }
}

}  // namespace

Rendered RenderBundles(const World& world, Sampler& sampler, const PartitionChoice& choice,
                       const Round& round) {
  if (world.rank == world.size - 1) return Serve(world, choice, round);
  Rendered rendered;
  rendered.messages = TraceOnDemand(world, sampler, choice, round);
  return rendered;
}

}  // namespace stipple::raytracer
