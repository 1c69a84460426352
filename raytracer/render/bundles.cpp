// SPDX-License-Identifier: MIT
// Bundles on demand. A node asks by sending what it found; its first, empty message asks too. The
// host answers with the number of the next bundle, or kNoBundle when there is none left, before it
// looks at what came in: the node should not wait for the host's bookkeeping.
//
// It ends because each node sends exactly one message per bundle it was given and one more, and the
// host answers each one.
#include "raytracer/render/marks.h"
#include "raytracer/render/render.h"

namespace stipple::raytracer {
namespace {

constexpr int kResultTag = 2;
constexpr int kBundleTag = 3;
constexpr std::uint32_t kNoBundle = 0xffffffff;

[[gnu::noinline]] std::vector<RayResult> TraceBundle(Sampler& sampler,
                                                     const std::vector<RasterPoint>& points) {
  std::vector<RayResult> results;
  results.reserve(points.size());
  for (const RasterPoint point : points) results.push_back(sampler.Sample(point));
  RecordCounts(sampler.counts());
  return results;
}

class Host {
 public:
  Host(const World& world, const PartitionChoice& choice)
      : world_(world),
        bundles_(choice),
        given_(static_cast<std::size_t>(world.size - 1), kNoBundle),
        working_(world.size - 1),
        raster_(PointCount(choice.raster)),
        incoming_(choice.bundle < raster_.size() ? choice.bundle : raster_.size()) {}

  void Serve() {
    while (working_ > 0) {
      MPI_Status status;
      MPI_Recv(incoming_.data(), static_cast<int>(incoming_.size()), type_.get(), MPI_ANY_SOURCE,
               kResultTag, world_.comm, &status);
      const std::uint32_t finished = HandOut(status.MPI_SOURCE);
      if (finished != kNoBundle) Place(bundles_.Points(finished), incoming_, raster_);
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

  const World& world_;
  Bundles bundles_;
  std::uint32_t next_ = 0;
  std::vector<std::uint32_t> given_;  // by node: the bundle it is working on
  int working_;                       // nodes that have not been told to stop
  Raster raster_;
  std::vector<RayResult> incoming_;
  ResultType type_;
  std::uint64_t messages_ = 0;
};

[[gnu::noinline]] std::uint64_t Serve(const World& world, const PartitionChoice& choice,
                                      Raster& raster) {
  MarkHost();
  Host host(world, choice);
  host.Serve();
  raster = host.TakeRaster();
  return host.messages();
}

[[gnu::noinline]] std::uint64_t TraceOnDemand(const World& world, Sampler& sampler,
                                              const PartitionChoice& choice) {
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
    results = TraceBundle(sampler, bundles.Points(bundle));
  }
}

}  // namespace

Rendered RenderBundles(const World& world, Sampler& sampler, const PartitionChoice& choice) {
  Rendered rendered;
  if (world.rank == world.size - 1)
    rendered.messages = Serve(world, choice, rendered.raster);
  else
    rendered.messages = TraceOnDemand(world, sampler, choice);
  rendered.counts = sampler.counts();
  return rendered;
}

}  // namespace stipple::raytracer
