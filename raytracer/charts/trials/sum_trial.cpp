// SPDX-License-Identifier: MIT
#include "raytracer/charts/trials/sum_trial.h"

#include <algorithm>
#include <array>
#include <utility>

#include "raytracer/charts/trials/random.h"
#include "raytracer/geometry/surface.h"
#include "raytracer/render/shader.h"

namespace stipple::raytracer {
namespace {

/// Follows rays as Tracer does, and keeps what they would add up.
class Collector {
 public:
  using Shading = Shader<double, Rules::kTransmitting>;

  Collector(const Scene& scene, const Model<double>& model, const Kernel<double>& kernel)
      : model_(model), kernel_(kernel), shader_(scene, {}, kernel.Rounding()) {}

  void TraceEye(const Ray<double>& ray, std::uint32_t point) {
    point_ = point;
    Trace({ray, 1, 1, {}});
  }
  std::vector<Contribution> Take() { return std::move(found_); }

 private:
  struct Next {
    Collector& collector;

    template <class Gain>
    void ToLight(const Ray<double>& ray, double distance, Gain gain) {
      if (!collector.kernel_.Occluded(ray, distance, collector.shader_.counts().tests))
        collector.Keep(gain());
    }
    void Go(const Shading::Leg& leg) { collector.Trace(leg); }
  };

  void Keep(Vec3 color) {
    found_.push_back({point_, static_cast<std::uint32_t>(found_.size()), color});
  }

  void Trace(const Shading::Leg& leg) {
    const Hit<double> hit = kernel_.Intersect(leg.ray, shader_.counts().tests);
    if (hit.object == kNoObject) return Keep(shader_.background() * leg.throughput);
    const Normals<double> normals = NormalsAt(model_, hit, shader_.PointAt(leg.ray, hit.t));
    Next next{*this};
    RayResult ignored;
    shader_.Shade(leg,
                  shader_.SurfaceAt(leg.ray, hit.t, normals, model_.objects[hit.object].material),
                  hit.object, false, ignored, next);
  }

  const Model<double>& model_;
  const Kernel<double>& kernel_;
  Shading shader_;
  std::uint32_t point_ = 0;
  std::vector<Contribution> found_;
};

/// Adds numbers of kind `Sum`, rounded to it when they are sent.
template <class Sum>
ExactSums AsTheyArrive(std::span<const Contribution> arriving, std::size_t points) {
  std::vector<Sum> sums(3 * points);
  for (const Contribution& c : arriving) {
    Sum* sum = sums.data() + 3 * std::size_t{c.point};
    sum[0] += static_cast<Sum>(c.color.x);
    sum[1] += static_cast<Sum>(c.color.y);
    sum[2] += static_cast<Sum>(c.color.z);
  }
  return {sums.begin(), sums.end()};
}

ExactSums InFixedPoint(std::span<const Contribution> arriving, std::size_t points) {
  std::vector<FixedColor> sums(points);
  for (const Contribution& c : arriving) Deposit(c.color, sums[c.point]);
  ExactSums exact;
  exact.reserve(3 * points);
  for (const FixedColor& sum : sums)
    for (const std::int64_t component : {sum.red, sum.green, sum.blue})
      exact.push_back(static_cast<long double>(component) / static_cast<long double>(kFixedOne));
  return exact;
}

ExactSums Sorted(std::span<const Contribution> arriving, std::size_t points) {
  std::vector<std::vector<Contribution>> kept(points);
  for (const Contribution& c : arriving) kept[c.point].push_back(c);
  std::vector<double> sums(3 * points);
  for (std::size_t point = 0; point < points; ++point) {
    std::ranges::sort(kept[point], {}, &Contribution::place);
    for (const Contribution& c : kept[point]) {
      sums[3 * point] += c.color.x;
      sums[3 * point + 1] += c.color.y;
      sums[3 * point + 2] += c.color.z;
    }
  }
  return {sums.begin(), sums.end()};
}

constexpr std::array kMethods{
    SumMethod{"float", 3 * sizeof(float), 3 * sizeof(float), AsTheyArrive<float>},
    SumMethod{"double", 3 * sizeof(double), 3 * sizeof(double), AsTheyArrive<double>},
    SumMethod{"fixed point", sizeof(FixedColor), sizeof(FixedColor), InFixedPoint},
    SumMethod{"sorted first", 3 * sizeof(double) + sizeof(std::uint32_t), sizeof(Contribution),
              Sorted}};

}  // namespace

std::vector<Contribution> ContributionsOf(const Scene& scene, const Model<double>& model,
                                          const Kernel<double>& kernel, ImageSize image,
                                          Samples samples) {
  const ImageSize raster = RasterOf(image, samples);
  const SampleRays<double> rays(scene.view, raster, samples);
  Collector collector(scene, model, kernel);
  for (RasterPoint point = 0; point < PointCount(raster); ++point)
    for (std::size_t i = 0; i < rays.count(); ++i)
      collector.TraceEye(rays.Through(point, i), static_cast<std::uint32_t>(point));
  return collector.Take();
}

std::vector<Contribution> Arrival(std::span<const Contribution> serial, std::uint32_t window,
                                  std::uint64_t seed) {
  std::vector<Contribution> order(serial.begin(), serial.end());
  Random random(seed);
  for (auto begin = order.begin(); begin != order.end();) {
    const std::uint32_t last = begin->point / window;
    const auto end = std::find_if(begin, order.end(), [window, last](const Contribution& c) {
      return c.point / window != last;
    });
    for (auto left = end - begin; left > 1; --left)
      std::swap(begin[left - 1], begin[random.Below(static_cast<int>(left))]);
    begin = end;
  }
  return order;
}

std::span<const SumMethod> SumMethods() { return kMethods; }

ExactSums SumExactly(std::span<const Contribution> contributions, std::size_t points) {
  return AsTheyArrive<long double>(contributions, points);
}

}  // namespace stipple::raytracer
