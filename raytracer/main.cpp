// SPDX-License-Identifier: MIT
// A ray tracer on MPI ranks; the program that stipple's exemplar traces.
#include <fmt/format.h>
#include <mpi.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>

#include "raytracer/errors.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/image/compare.h"
#include "raytracer/image/exr_file.h"
#include "raytracer/image/png_file.h"
#include "raytracer/options.h"
#include "raytracer/render/marks.h"
#include "raytracer/render/picture.h"
#include "raytracer/render/render.h"
#include "raytracer/report.h"
#include "raytracer/scene/load.h"
#include "raytracer/scene/nff.h"

namespace stipple::raytracer {
namespace {

constexpr int kDifferent = 1;  // exit status of --compare
constexpr int kUnusable = 2;   // exit status after InputError and UsageError

/// Seconds since it was made or last asked: of the clock on the wall, and of CPU time of the
/// process.
class Stopwatch {
 public:
  double Lap() {
    const double now = MPI_Wtime();
    return now - std::exchange(start_, now);
  }
  double LapCpu() {
    const double now = CpuSeconds();
    return now - std::exchange(cpu_start_, now);
  }

 private:
  static double CpuSeconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double start_ = MPI_Wtime();
  double cpu_start_ = CpuSeconds();
};

int PrintComparison(const Options& options) {
  const LinearImage a = ReadPicture(options.compare.first);
  const LinearImage b = ReadPicture(options.compare.second);
  const ImageDifference difference = Compare(a, b);
  if (!options.output.empty() && difference.SameSize())
    WritePng(DifferencePicture(a, b), options.output);
  fmt::print("{}", DifferenceText(difference));
  return difference.Identical() ? 0 : kDifferent;
}

Scene Load(const World& world, const Options& options) {
  Mark(Moment::kLoadBegins);
  const SceneChoice choice{options.scene, options.scene_size,
                           static_cast<std::uint64_t>(options.object_limit), options.camera};
  Scene scene = OnAllRanks(world, [&] { return LoadScene(choice); });
  if (options.resolution.width > 0) scene.view.resolution = options.resolution;
  return scene;
}

template <class Real>
Model<Real> Build(const World& world, Scene& scene, const Options& options) {
  Mark(Moment::kBuildBegins);
  return OnAllRanks(world, [&] {
    return BuildModel<Real>(std::move(scene.shapes), HierarchyFor(options.kernel));
  });
}

template <class Real>
std::uint64_t BytesOf(Model<Real>& model) {
  std::uint64_t bytes = 0;
  model.ForEachArray([&bytes](const auto& array) { bytes += array.size() * sizeof(array[0]); });
  return bytes;
}

template <class Real>
Rendered RenderScene(const World& world, const Scene& scene, const Model<Real>& model,
                     const Kernel<Real>& kernel, const Options& options) {
  const ImageSize image = scene.view.resolution;
  const PartitionChoice choice{RasterOf(image, options.samples), options.tile,
                               static_cast<std::uint32_t>(options.bundle), options.select,
                               static_cast<std::uint64_t>(options.seed)};
  const ShadingChoice shading{static_cast<int>(options.max_depth), options.min_contribution};
  const auto sampler = MakeSampler(scene, model, kernel, shading, image, options.samples);
  return Render(world, *sampler, options.partition, choice, options.samples);
}

void WriteText(const std::string& text, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw InputError(path, 0, fmt::format("cannot be written: {}", std::strerror(errno)));
}

void WritePictures(const Raster& raster, ImageSize image, const Options& options) {
  Mark(Moment::kOutputBegins);
  if (options.output.ends_with(".exr"))
    WriteExr(LinearPictureOf(raster, image, options.samples), options.output);
  else if (!options.output.empty())
    WritePng(PictureOf(raster, image, options.samples), options.output);
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

template <class Real>
void RenderAndReport(const World& world, Scene& scene, const Options& options, RankReport report) {
  Stopwatch watch;
  Model<Real> model = Build<Real>(world, scene, options);
  const auto kernel = OnAllRanks(world, [&] { return MakeKernel(options.kernel, model); });
  report.build_s = watch.Lap();
  report.build_cpu_s = watch.LapCpu();
  const Rendered rendered = RenderScene(world, scene, model, *kernel, options);
  report.render_s = watch.Lap();
  report.render_cpu_s = watch.LapCpu();
  report.counts = rendered.counts;
  report.messages = rendered.messages;
  OnRank(world, AssemblingRank(world, options.partition), [&] {
    const ImageSize image = scene.view.resolution;
    report.loss = LossOf(rendered.raster, image, options.samples);
    WritePictures(rendered.raster, image, options);
  });
  const RunReport run{model.objects.size(), BytesOf(model), GatherReports(world, report)};
  OnRank(world, 0, [&] { WriteReport(run, options); });
}

void LoadAndRender(const World& world, const Options& options) {
  if (options.output.ends_with(".exr")) OnRank(world, 0, [&] { NeedExr(options.output); });
  Stopwatch watch;
  RankReport report;
  Scene scene = Load(world, options);
  report.load_s = watch.Lap();
  if (!options.write_scene.empty()) {
    OnRank(world, 0, [&] { WriteNff(scene, options.write_scene); });
    if (world.rank == 0)
      fmt::print("wrote {}: {} objects\n", options.write_scene, scene.shapes.objects.size());
  } else if (options.precision == "float") {
    RenderAndReport<float>(world, scene, options, report);
  } else {
    RenderAndReport<double>(world, scene, options, report);
  }
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
  try {
    return Run(world, argc, argv);
  } catch (const StoppedTogether& stop) {
    if (*stop.what() != '\0') fmt::print(stderr, "raytracer: {}\n", stop.what());
    return kUnusable;
  }
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int status = stipple::raytracer::RunOrReport(argc, argv);
  MPI_Finalize();
  return status;
}
