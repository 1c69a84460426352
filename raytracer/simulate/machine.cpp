// SPDX-License-Identifier: MIT
// SimGrid loads this library as its platform; the ranks are linked to it.
#include "raytracer/simulate/machine.h"

#include <fmt/format.h>
#include <simgrid/engine.h>
#include <smpi/smpi.h>

#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <simgrid/s4u.hpp>
#include <string>

#include "raytracer/simulate/machines.h"
#include "raytracer/simulate/network_log.h"

namespace stipple::simulate {
namespace {

namespace s4u = simgrid::s4u;

constexpr int kUnusable = 2, kDeadlocked = 3;  // exit status

struct Run {
  const MachineRow* machine = nullptr;
  int nodes = 0;
  bool host = false;
  std::uint64_t host_overhead_ns = 0;
  Node node;  // what ranks see
  void* shared = nullptr;
};

/// Never destroyed: ranks look at it until the process is gone.
Run& ThisRun() {
  static Run* run = new Run;
  return *run;
}

[[noreturn]] void Refuse(const std::string& problem) {
  fmt::print(stderr, "stipple simulate: {}\n", problem);
  std::_Exit(kUnusable);
}

std::string Variable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

double Number(const char* name, double preset) {
  const std::string text = Variable(name);
  if (text.empty()) return preset;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0) || value > 1e6)
    Refuse(fmt::format("{} is no number from 0 to 1000000: '{}'", name, text));
  return value;
}

const MachineRow& MachineNamed(const std::string& name) {
  std::string known;
  for (const MachineRow& row : Machines()) {
    if (row.name == name) return row;
    known += fmt::format("\n  {:8} up to {:4} nodes: {}", row.name, row.most_nodes, row.what);
  }
  Refuse(fmt::format("--machine {}: unknown; known are{}", name, known));
}

std::uint64_t Ns(double seconds) { return static_cast<std::uint64_t>(std::llround(seconds * 1e9)); }

std::uint64_t Scaled(std::uint64_t price_ps, double scale) {
  return static_cast<std::uint64_t>(std::llround(static_cast<double>(price_ps) * scale));
}

Prices Scaled(const Prices& prices, double scale) {
  return {Scaled(prices.box_test_ps, scale), Scaled(prices.primitive_test_ps, scale),
          Scaled(prices.ray_ps, scale), Scaled(prices.shadow_ray_ps, scale)};
}

/// The machine's, or others to see what they change: STIPPLE_PRICES, four numbers of picoseconds in
/// the order of Prices (tests/bench/simulate).
Prices PricesOf(const MachineRow& machine) {
  const std::string text = Variable("STIPPLE_PRICES");
  if (text.empty()) return machine.prices;
  Prices prices;
  char end = 0;
  if (std::sscanf(text.c_str(), "%" SCNu64 ",%" SCNu64 ",%" SCNu64 ",%" SCNu64 "%c",
                  &prices.box_test_ps, &prices.primitive_test_ps, &prices.ray_ps,
                  &prices.shadow_ray_ps, &end) != 4)
    Refuse(fmt::format("STIPPLE_PRICES are not four numbers of picoseconds: '{}'", text));
  return prices;
}

/// For SMPI: what a processor does before or after a message, by its size.
std::string Factors(const StartUp& start_up) {
  return fmt::format("0:{:.9f}:0;{}:{:.9f}:0", static_cast<double>(start_up.short_ns) * 1e-9,
                     kLongBytes + 1, static_cast<double>(start_up.long_ns) * 1e-9);
}

void SetStartUp(s4u::Host* host, const StartUp& send, const StartUp& receive) {
  host->set_property("smpi/os", Factors(send));
  host->set_property("smpi/ois", Factors(send));
  host->set_property("smpi/or", Factors(receive));
}

/// Reads what is to be simulated from the environment (docs/stipple-simulate.md names the options).
void ReadRun(Run& run) {
  run.machine = &MachineNamed(Variable("STIPPLE_MACHINE"));
  run.nodes = static_cast<int>(Number("STIPPLE_NODES", 1));
  if (run.nodes < 1 || run.nodes > run.machine->most_nodes)
    Refuse(fmt::format("--nodes {}: {} has from 1 to {} nodes", run.nodes, run.machine->name,
                       run.machine->most_nodes));
  run.host = run.machine->always_host || !Variable("STIPPLE_HOST").empty();
  run.host_overhead_ns = Ns(Number("STIPPLE_HOST_OVERHEAD", run.machine->host_overhead_s));
  const double scale = Number("STIPPLE_WORK_SCALE", 1);
  run.node = {.prices = Scaled(PricesOf(*run.machine), scale),
              .event_ns = Ns(Number("STIPPLE_EVENT_COST", 0)),
              .memory_bytes = run.machine->memory_bytes,
              .has_host = run.machine->always_host};
}

void BuildPlatform(const Run& run) {
  s4u::NetZone* root = s4u::create_full_zone("root");
  run.machine->network(*run.machine, root, run.nodes, run.host);
  root->seal();
  int rank = 0;
  for (s4u::Host* host : s4u::Engine::get_instance()->get_all_hosts()) {
    SetStartUp(host, SendOf(rank), ReceiveOf(rank));
    ++rank;
  }
}

/// Nothing is under way that any rank that is left could go on with. Where each of them waits is
/// known to the archive, which stipple simulate reads.
void SayDeadlock() {
  fmt::print(stderr,
             "stipple simulate: deadlock at {:.6f} s of the machine: the ranks wait for messages "
             "that nobody will send\n",
             simgrid_get_clock());
  std::fflush(nullptr);
  std::_Exit(kDeadlocked);
}

}  // namespace

std::uint64_t StartUp::Of(std::uint64_t bytes) const {
  return bytes > kLongBytes ? long_ns : short_ns;
}

const Node& ThisNode() { return ThisRun().node; }

StartUp SendOf(int rank) {
  const Run& run = ThisRun();
  if (!run.host || rank != run.nodes) return run.machine->send;
  return {run.host_overhead_ns, run.host_overhead_ns};
}

StartUp ReceiveOf(int rank) {
  const Run& run = ThisRun();
  if (!run.host || rank != run.nodes) return run.machine->receive;
  return {run.host_overhead_ns, run.host_overhead_ns};
}

std::uint64_t Now() { return Ns(simgrid_get_clock()); }

void Compute(std::uint64_t ns) { smpi_execute_flops(static_cast<double>(ns)); }

bool TakeTransmission(int rank, Transmission& transmission) {
  return NetworkLog::Instance().Take(rank, transmission);
}

void*& SharedPlace() { return ThisRun().shared; }

}  // namespace stipple::simulate

extern "C" __attribute__((visibility("default"))) void load_platform(const simgrid::s4u::Engine&) {
  using namespace stipple::simulate;
  Run& run = ThisRun();
  ReadRun(run);
  BuildPlatform(run);
  NetworkLog::Instance().Begin();
  using simgrid::s4u::Engine;
  Engine::set_config("smpi/np:" + std::to_string(run.nodes + (run.host ? 1 : 0)));
  Engine::set_config(fmt::format("smpi/iprobe:{:.9f}", run.machine->look_s));
  Engine::set_config(fmt::format("smpi/test:{:.9f}", run.machine->look_s));
  Engine::on_deadlock_cb(SayDeadlock);
}
