// SPDX-License-Identifier: MIT
#include "raytracer/render/marks.h"

#include <stipple/user.h>

#include <cstddef>

namespace stipple::raytracer {
namespace {

// By Moment.
stipple_name moment_names[] = {{"load begins", "", 0},     {"build begins", "", 0},
                               {"render begins", "", 0},   {"supply ends", "", 0},
                               {"assemble begins", "", 0}, {"output begins", "", 0}};

struct CounterRow {
  stipple_name name;
  std::uint64_t (*value)(const RayCounts& counts);
};
CounterRow counter_rows[] = {
    {{"box tests", "tests", 0}, [](const RayCounts& c) { return c.tests.box_tests; }},
    {{"primitive tests", "tests", 0}, [](const RayCounts& c) { return c.tests.primitive_tests; }},
    {{"eye rays", "rays", 0}, [](const RayCounts& c) { return c.eye_rays; }},
    {{"shadow rays", "rays", 0}, [](const RayCounts& c) { return c.shadow_rays; }},
    {{"reflected rays", "rays", 0}, [](const RayCounts& c) { return c.reflected_rays; }},
    {{"refracted rays", "rays", 0}, [](const RayCounts& c) { return c.refracted_rays; }},
    {{"repeated tests", "tests", 0}, [](const RayCounts& c) { return c.repeated_tests; }}};

stipple_name bundles_left = {"bundles left", "bundles", 0};
stipple_name rays_waiting = {"rays waiting", "rays", 0};
stipple_name rays_received = {"rays received", "rays", 0};
stipple_name rays_sent = {"rays sent", "rays", 0};

}  // namespace

void Mark(Moment moment) { stipple_mark(&moment_names[static_cast<std::size_t>(moment)]); }

void MarkHost() { stipple_host(); }

void RecordCounts(const RayCounts& counts) {
  for (CounterRow& row : counter_rows)
    stipple_counter(&row.name, static_cast<double>(row.value(counts)));
}

void RecordBundlesLeft(std::uint32_t bundles) { stipple_counter(&bundles_left, bundles); }

void RecordTravel(std::size_t waiting, std::uint64_t received, std::uint64_t sent) {
  stipple_counter(&rays_waiting, static_cast<double>(waiting));
  stipple_counter(&rays_received, static_cast<double>(received));
  stipple_counter(&rays_sent, static_cast<double>(sent));
}

}  // namespace stipple::raytracer
