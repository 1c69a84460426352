// SPDX-License-Identifier: MIT
// A ray tracer on MPI ranks; the program that stipple's exemplar traces.
#include <fmt/format.h>
#include <mpi.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <fstream>
#include <new>

#include "raytracer/errors.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/image/compare.h"
#include "raytracer/image/exr_file.h"
#include "raytracer/image/png_file.h"
#include "raytracer/options.h"
#include "raytracer/partition/scene_parts.h"
#include "raytracer/plan.h"
#include "raytracer/render/coupled.h"
#include "raytracer/render/divided.h"
#include "raytracer/render/machine.h"
#include "raytracer/render/marks.h"
#include "raytracer/render/picture.h"
#include "raytracer/render/render.h"
#include "raytracer/report.h"
#include "raytracer/scene/load.h"
#include "raytracer/scene/nff.h"
#include "raytracer/scene/shared_scene.h"
#include "raytracer/stopwatch.h"
#include "raytracer/whole_file.h"

namespace stipple::raytracer {
namespace {

constexpr int kDifferent = 1;  // exit status of --compare
constexpr int kUnusable = 2;   // exit status after InputError and UsageError

int PrintComparison(const Options& options) {
  const LinearImage a = ReadPicture(options.compare.first);
  const LinearImage b = ReadPicture(options.compare.second);
  const ImageDifference difference = Compare(a, b);
  if (!options.output.empty() && difference.SameSize())
    WritePng(DifferencePicture(a, b), options.output);
  fmt::print("{}", DifferenceText(difference));
  return difference.Identical() ? 0 : kDifferent;
}

SceneChoice ChoiceOf(const Options& options) {
  return {options.scene,
          options.scene_size,
          static_cast<std::uint64_t>(options.object_limit),
          options.camera,
          static_cast<std::uint64_t>(options.memory_limit),
          options.resolution,
          options.patches};
}

PartitionChoice PointsOf(ImageSize image, const Options& options) {
  return {RasterOf(image, options.samples), options.tile,
          static_cast<std::uint32_t>(options.bundle), options.select,
          static_cast<std::uint64_t>(options.seed)};
}

template <class Real>
Rendered RenderScene(const World& world, const Scene& scene, const Model<Real>& model,
                     const Kernel<Real>& kernel, int depth, const Options& options) {
  const ImageSize image = scene.view.resolution;
  const ShadingChoice shading{depth, options.min_contribution};
  const auto sampler = MakeSampler(scene, model, kernel, shading, image, options.samples);
  const WorkMeter meter(sampler->counts());
  return Render(world, *sampler, options.partition, PointsOf(image, options), options.samples);
}

void WriteText(const std::string& text, const std::string& path) {
  WriteWhole(path, [&](const std::string& name) {
    std::ofstream file(name, std::ios::binary);
    file << text;
    file.close();
    if (!file)
      throw InputError(path, 0, fmt::format("cannot be written: {}", std::strerror(errno)));
  });
}

/// What the picture lacks at most, be it written or not.
LossBound WritePicture(RasterView raster, ImageSize image, const Options& options) {
  if (options.output.empty()) return LossOf(raster, image, options.samples);
  if (options.output.ends_with(".exr")) {
    const auto [picture, loss] = LinearPictureOf(raster, image, options.samples);
    WriteExr(picture, options.output);
    return loss;
  }
  const auto [picture, loss] = PictureOf(raster, image, options.samples);
  WritePng(picture, options.output);
  return loss;
}

void WriteCostMap(RasterView raster, ImageSize image, const Options& options) {
  if (options.cost_map.ends_with(".png"))
    WritePng(CostImageOf(raster, image, options.samples), options.cost_map);
  else if (!options.cost_map.empty())
    WriteText(CostTableOf(raster, image, options.samples), options.cost_map);
}

void WriteReport(const RunReport& report, const Options& options) {
  if (!options.stats.empty()) WriteText(StatsJson(report), options.stats);
  fmt::print("{}", Summary(report));
  for (const std::string* path : {&options.output, &options.cost_map, &options.stats})
    if (!path->empty()) fmt::print("  wrote {}\n", *path);
  if (options.output.empty()) fmt::print("  no picture written: --output F.png writes one\n");
}

/// Does `work` on one rank only; if it fails there, all ranks stop.
template <class Work>
void OnRank(const World& world, int rank, Work work) {
  OnAllRanks(world, [&] {
    if (world.rank == rank) work();
    return true;
  });
}

/// What is decided for this scene; rank 0 says why if it is asked to.
void Adapt(const World& world, const SceneFacts& facts, const Options& options) {
  OnAllRanks(world, [&] {
    RequireDigits(facts, options);
    return true;
  });
  OnRank(world, 0, [&] {
    if (options.explain) fmt::print("{}", Explanation(facts, options));
  });
}

/// What is left when the picture is there.
void Finish(const World& world, RasterView raster, ImageSize image, RunReport run,
            RankReport report, const std::string& kept_in, const Options& options) {
  OnRank(world, AssemblingRank(world, options.partition), [&] {
    Mark(Moment::kOutputBegins);
    report.loss = WritePicture(raster, image, options);
    WriteCostMap(raster, image, options);
  });
  run.ranks = GatherReports(world, report);
  OnRank(world, 0, [&] {
    WriteReport(run, options);
    if (!kept_in.empty()) fmt::print("  scene from {}\n", kept_in);
  });
}

template <class Real>
void RenderReplicated(const World& world, const Options& options) {
  SharedScene<Real> shared =
      SceneForAll<Real>(world, ChoiceOf(options), HierarchyFor(options.kernel));
  Scene& scene = shared.scene;
  RankReport report;
  report.load_s = shared.load_s;
  report.build_s = shared.build_s;
  report.build_cpu_s = shared.build_cpu_s;
  Stopwatch watch;
  const auto kernel = OnAllRanks(world, [&] { return MakeKernel(options.kernel, shared.model); });
  const SceneFacts facts = FactsOf(scene, shared.model);
  Adapt(world, facts, options);
  report.build_s += watch.Lap();
  report.build_cpu_s += watch.LapCpu();
  const Rendered rendered =
      RenderScene(world, scene, shared.model, *kernel,
                  DepthFor(facts, static_cast<int>(options.max_depth)), options);
  report.render_s = watch.Lap();
  report.render_cpu_s = watch.LapCpu();
  report.counts = rendered.counts;
  report.messages = rendered.messages;
  Finish(world, rendered.points, scene.view.resolution,
         {shared.model.objects.size(), facts.model_bytes, 0, 0, {}, {}}, report, shared.kept_in,
         options);
}

/// Objects divided among all ranks, but for the host. `fill`: as much on each as fits.
template <class Real>
void RenderPartitioned(const World& world, bool fill, const Options& options) {
  const bool host = AssemblingRank(world, options.partition) != 0;
  const bool coupled = options.objects == "coupled";
  const Division division{world.size - (host ? 1 : 0), options.replicate, fill, coupled};
  SceneParts<Real> parts = PartsForAll<Real>(world, ChoiceOf(options), options.kernel, division);
  RankReport report;
  report.load_s = parts.load_s;
  report.build_s = parts.build_s;
  report.build_cpu_s = parts.build_cpu_s;
  SceneFacts facts = FactsOf(world, parts);
  Adapt(world, facts, options);
  const ImageSize image = parts.scene.view.resolution;
  const ShadingChoice shading{DepthFor(facts, static_cast<int>(options.max_depth)),
                              options.min_contribution};
  std::optional<Forecast> forecast;
  if (coupled) {
    forecast = Couple(world, shading, options.kernel, parts);
    facts = FactsOf(world, parts);
  }
  const auto tracer = world.rank < division.holders
                          ? MakeRankTracer(parts, world.rank, shading, image, options.samples)
                          : nullptr;
  Stopwatch watch;
  const DividedChoice choice{
      options.partition,
      PointsOf(image, options),
      division.holders,
      static_cast<std::size_t>(options.package),
      coupled && !tracer ? WaysOf(parts, PointsOf(image, options), image, options.samples) : Ways(),
      &parts.holding};
  std::optional<WorkMeter> meter;
  if (tracer) meter.emplace(tracer->counts());
  const DividedRender divided = RenderDivided(world, tracer.get(), choice);
  report.render_s = watch.Lap();
  report.render_cpu_s = watch.LapCpu();
  report.counts = divided.rendered.counts;
  report.messages = divided.rendered.messages;
  report.travel = divided.travel;
  Finish(world, divided.rendered.points, image,
         {facts.Objects(), facts.model_bytes, facts.parts, facts.copies, forecast, {}}, report, "",
         options);
}

template <class Real>
void RenderAndReport(const World& world, const Options& options) {
  if (IsDivided(options)) return RenderPartitioned<Real>(world, false, options);
  try {
    RenderReplicated<Real>(world, options);
  } catch (const StoppedTogether& stop) {
    if (!stop.no_room || options.objects != "auto" || options.samples.adaptive || world.size == 1)
      throw;
    RenderPartitioned<Real>(world, true, options);
  }
}

void WriteScene(const Options& options) {
  const Scene scene = LoadScene(ChoiceOf(options));
  WriteNff(scene, options.write_scene);
  fmt::print("wrote {}: {} objects\n", options.write_scene, scene.shapes.objects.size());
}

void LoadAndRender(const World& world, const Options& options) {
  OnAllRanks(world, [&] {
    if (world.has_host && options.partition == "guided")
      throw UsageError(
          "--partition guided: ranks take work for themselves, but this machine has a host that "
          "hands "
          "it out: take --partition bundles, or a machine without a host (modern)");
    return true;
  });
  if (options.output.ends_with(".exr")) OnRank(world, 0, [&] { NeedExr(options.output); });
  if (!options.write_scene.empty())
    OnRank(world, 0, [&] { WriteScene(options); });
  else if (options.precision == "float")
    RenderAndReport<float>(world, options);
  else
    RenderAndReport<double>(world, options);
}

int Run(const World& world, int argc, char** argv) {
  const Options options = OnAllRanks(world, [&] { return ParseOptions(argc, argv); });
  int status = 0;
  if (options.help)
    OnRank(world, 0, [&] { fmt::print("{}", HelpText()); });
  else if (!options.compare.first.empty())
    OnRank(world, 0, [&] { status = PrintComparison(options); });
  else
    LoadAndRender(world, options);
  MPI_Bcast(&status, 1, MPI_INT, 0, world.comm);
  return status;
}

int RunOrReport(int argc, char** argv) {
  World world;
  MPI_Comm_rank(world.comm, &world.rank);
  MPI_Comm_size(world.comm, &world.size);
  world.has_host = MachineHasHost() && world.size > 1;
  try {
    return Run(world, argc, argv);
  } catch (const StoppedTogether& stop) {
    if (*stop.what() != '\0') fmt::print(stderr, "raytracer: {}\n", stop.what());
    return kUnusable;
  }
}

/// What one rank has not foreseen ends all: the others would wait for it.
[[noreturn]] void EndAll() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    std::fprintf(stderr, "raytracer: rank %d: ended by itself; this is a bug\n", rank);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "raytracer: rank %d: not enough memory\n", rank);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "raytracer: rank %d: %s; this is a bug\n", rank, error.what());
  }
  MPI_Abort(MPI_COMM_WORLD, kUnusable);
  std::abort();
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  std::set_terminate(stipple::raytracer::EndAll);
  const int status = stipple::raytracer::RunOrReport(argc, argv);
  MPI_Finalize();
  return status;
}
