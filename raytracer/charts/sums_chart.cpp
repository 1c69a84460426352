// SPDX-License-Identifier: MIT
// What rays contribute to a pixel, added up as it arrives from other nodes: in floating point two
// orders of arrival give two pictures, in fixed point there is one. Orders are seeded shuffles of
// the contributions of a real picture's rays, among the 512 points that a bundle has under way;
// no message is sent. The error is how far two orders' sums are apart; how far each is from the
// exact sum stands beside it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ranges>
#include <utility>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/charts/trials/sum_trial.h"

namespace stipple::raytracer {
namespace {

constexpr Samples kSamples{16};
constexpr std::uint32_t kBundle = 512;
constexpr int kOrders = 5;
constexpr std::string_view kRecommended = "fixed point", kSorted = "sorted first";
constexpr long double kLevels = 255;  // of a component in a file

using Orders = std::vector<std::vector<Contribution>>;

/// What one way to add gave for all orders.
struct Outcome {
  double cpu_s = 0;            // least, for a million contributions
  long double apart = 0;       // largest difference of a component between two orders, in levels
  long double rounding = 0;    // largest difference from the exact sum
  std::size_t points = 0;      // whose sums differ between orders
  std::size_t as_written = 0;  // and whose bytes do
};

long double Level(long double sum) {
  return std::round(std::clamp(sum / kSamples.per_pixel, 0.0L, 1.0L) * kLevels);
}

/// Sums of all orders against each other and against the exact ones.
void Compare(const std::vector<ExactSums>& sums, const ExactSums& exact, Outcome& outcome) {
  for (std::size_t point = 0; point < exact.size() / 3; ++point) {
    bool differs = false, written = false;
    for (std::size_t i = 3 * point; i < 3 * point + 3; ++i) {
      const auto of_order = [i](const ExactSums& order) { return order[i]; };
      const auto [low, high] = std::ranges::minmax(sums | std::views::transform(of_order));
      const long double to_level = kLevels / kSamples.per_pixel;
      outcome.apart = std::max(outcome.apart, (high - low) * to_level);
      outcome.rounding =
          std::max(outcome.rounding, std::max(high - exact[i], exact[i] - low) * to_level);
      differs = differs || low != high;
      written = written || Level(low) != Level(high);
    }
    outcome.points += differs ? 1 : 0;
    outcome.as_written += written ? 1 : 0;
  }
}

/// The ways in turn, round after round.
std::vector<Outcome> Try(Session& session, const Orders& orders, const ExactSums& exact) {
  const std::span<const SumMethod> methods = SumMethods();
  const auto millions = static_cast<double>(orders[0].size()) / 1e6;
  std::vector<Outcome> outcomes(methods.size());
  std::vector<std::vector<ExactSums>> sums(methods.size());
  for (int round = 0; round < session.rounds(); ++round)
    for (const std::vector<Contribution>& order : orders)
      for (std::size_t m = 0; m < methods.size(); ++m) {
        const double begin = CpuSeconds();
        ExactSums found = methods[m].sum(order, exact.size() / 3);
        const double spent = (CpuSeconds() - begin) / millions;
        double& least = outcomes[m].cpu_s;
        least = least == 0 ? spent : std::min(least, spent);
        if (round == 0) sums[m].push_back(std::move(found));
        session.progress.Advance(1);
      }
  for (std::size_t m = 0; m < methods.size(); ++m) Compare(sums[m], exact, outcomes[m]);
  return outcomes;
}

/// For the sentence.
struct Gains {
  std::vector<double> time;  // fixed point's over double's
  double float_apart = 0, double_apart = 0, rounding = 0;
  std::size_t float_written = 0, double_written = 0;

  void Add(std::span<const Outcome> outcomes) {
    const Outcome &in_float = outcomes[0], &in_double = outcomes[1], &fixed = outcomes[2];
    time.push_back(fixed.cpu_s / in_double.cpu_s);
    float_apart = std::max(float_apart, static_cast<double>(in_float.apart));
    double_apart = std::max(double_apart, static_cast<double>(in_double.apart));
    rounding = std::max(rounding, static_cast<double>(fixed.rounding));
    float_written += in_float.as_written;
    double_written += in_double.as_written;
  }
};

void AddScene(Session& session, const ChartScene& scene, ChartTable& table, Gains& gains) {
  const ReadyScene<double>& ready = session.Ready(scene);
  const std::vector<Contribution> serial =
      ContributionsOf(ready.scene, ready.model, *ready.kernel, session.image(), kSamples);
  Orders orders;
  for (int seed = 1; seed <= kOrders; ++seed)
    orders.push_back(Arrival(serial, kBundle, static_cast<std::uint64_t>(seed)));
  const ExactSums exact = SumExactly(serial, PointCount(RasterOf(session.image(), kSamples)));
  const std::span<const SumMethod> methods = SumMethods();
  session.progress.Begin(fmt::format("sums, {}", scene.name),
                         static_cast<double>(methods.size()) * kOrders * session.rounds());
  const std::vector<Outcome> outcomes = Try(session, orders, exact);
  const auto per_point = static_cast<double>(serial.size()) / static_cast<double>(exact.size() / 3);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const Outcome& o = outcomes[m];
    const bool keeps = methods[m].name == kSorted;
    const double held = methods[m].bytes_held * (keeps ? per_point : 1);
    const std::string name =
        keeps ? std::string(kSorted) : fmt::format("{}: {:.0f} bytes", methods[m].name, held);
    table.points.push_back(
        {scene.name,
         name,
         name,
         o.cpu_s,
         static_cast<double>(o.apart),
         methods[m].name == kRecommended,
         {static_cast<double>(o.rounding), static_cast<double>(o.points),
          static_cast<double>(o.as_written), static_cast<double>(methods[m].bytes_sent), held}});
  }
  gains.Add(outcomes);
}

}  // namespace

ChartTable SumsChart(Session& session) {
  ChartTable table{.name = "sums", .title = "Sums of what arrives in any order"};
  table.x.title = "CPU seconds for a million contributions";
  table.y.title = "two orders of arrival apart by at most, in 255ths";
  table.more_columns = {"from_exact_levels", "points_apart", "pixels_apart_as_written",
                        "bytes_sent_per_contribution", "bytes_held_per_point"};
  Gains gains;
  for (const ChartScene& scene : kChartScenes) AddScene(session, scene, table, gains);
  table.sentence = fmt::format(
      "Add in fixed point: the same sums in any order, at most {} of a 255th from the exact ones, "
      "in "
      "{} times the time of double and the same bytes; orders differ in float by up to {} of a "
      "255th and in {} pixels of a file, in double by {} and in {}.",
      ShortNumber(gains.rounding), RangeText(gains.time), ShortNumber(gains.float_apart),
      gains.float_written, ShortNumber(gains.double_apart), gains.double_written);
  return table;
}

}  // namespace stipple::raytracer
