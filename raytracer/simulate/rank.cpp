// SPDX-License-Identifier: MIT
// A rank on the simulated machine: what its work costs, and what time it is.
//
// Work is charged by what the ray tracer counts anyway. Nobody tells when it is done: whoever asks
// for the time gets the machine's clock and the price of what was counted since the rank last let
// time pass, so that each event of the trace has its own time. Time passes, for the other ranks to
// see, only where they can see it: before a call of MPI (Settle, from the MPI layer).
#include <mpi.h>
#include <stipple/user.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "raytracer/render/machine.h"
#include "raytracer/simulate/machine.h"

namespace stipple::raytracer {
namespace {

constexpr std::uint64_t kPsPerNs = 1000;

const RayCounts* metered = nullptr;
std::uint64_t earlier_ps = 0;  // price of what earlier meters have counted
std::uint64_t settled_ns = 0;  // of the work
std::uint64_t charged_ns = 0;  // by stipple_charge, not settled
std::uint64_t last_ns = 0;     // the time never goes back
bool begun = false, ended = false;

std::uint64_t PriceOf(const RayCounts& counts) {
  const simulate::Prices& prices = simulate::ThisNode().prices;
  return counts.tests.box_tests * prices.box_test_ps +
         counts.tests.primitive_tests * prices.primitive_test_ps +
         (counts.eye_rays + counts.reflected_rays + counts.refracted_rays) * prices.ray_ps +
         counts.shadow_rays * prices.shadow_ray_ps;
}

std::uint64_t WorkNs() {
  return (earlier_ps + (metered == nullptr ? 0 : PriceOf(*metered))) / kPsPerNs;
}

std::uint64_t Now() {
  if (begun && !ended)
    last_ns = std::max(last_ns, simulate::Now() + WorkNs() - settled_ns + charged_ns);
  return last_ns;
}

void Charge(std::uint64_t ns) { charged_ns += ns; }

void Settle() {
  begun = true;
  if (ended) return;
  const std::uint64_t work_ns = WorkNs();
  const std::uint64_t passes = work_ns - settled_ns + charged_ns;
  settled_ns = work_ns;
  charged_ns = 0;
  if (passes != 0) simulate::Compute(passes);
}

void End() {
  Now();
  ended = true;
}

/// In the world; asked for after MPI_Init.
int Rank() {
  static int rank = -1;
  if (rank < 0 && !ended) PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

std::uint64_t SendNs(std::uint64_t bytes) { return simulate::SendOf(Rank()).Of(bytes); }
std::uint64_t ReceiveNs(std::uint64_t bytes) { return simulate::ReceiveOf(Rank()).Of(bytes); }

int NextTransmission(stipple_transmission* next) {
  simulate::Transmission taken;
  if (!simulate::TakeTransmission(Rank(), taken)) return 0;
  *next = {taken.begin_ns, taken.end_ns, taken.bytes, taken.receiver, 0};
  return 1;
}

stipple_simulator simulator = {Now, Charge, Settle, End, SendNs, ReceiveNs, NextTransmission, 0};

[[gnu::constructor]] void Begin() {
  simulator.event_ns = simulate::ThisNode().event_ns;
  stipple_simulated_by(&simulator);
}

}  // namespace

WorkMeter::WorkMeter(const RayCounts& counts) { metered = &counts; }

WorkMeter::~WorkMeter() {
  earlier_ps += PriceOf(*metered);
  metered = nullptr;
}

bool MachineHasHost() { return simulate::ThisNode().has_host; }

// Each rank is a computer of its own, whose results travel in messages.
bool RanksShareMemory() { return false; }

}  // namespace stipple::raytracer

// The program's own questions for the time.

extern "C" double MPI_Wtime() { return static_cast<double>(stipple::raytracer::Now()) * 1e-9; }

extern "C" int clock_gettime(clockid_t, timespec* now) noexcept {
  constexpr std::uint64_t kNsPerSecond = 1'000'000'000;
  const std::uint64_t ns = stipple::raytracer::Now();
  *now = {static_cast<time_t>(ns / kNsPerSecond), static_cast<long>(ns % kNsPerSecond)};
  return 0;
}
