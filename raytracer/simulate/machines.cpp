// SPDX-License-Identifier: MIT
#include "raytracer/simulate/machines.h"

#include <array>
#include <string>
#include <vector>

namespace stipple::simulate {
namespace {

namespace s4u = simgrid::s4u;

constexpr double kNsPerSecond = 1e9;  // a host computes one unit in a nanosecond

/// A host whose name tells its rank. Ranks are given to hosts in the order of their names.
s4u::Host* MakeHost(s4u::NetZone* zone, unsigned long rank) {
  const std::string number = std::to_string(rank);
  s4u::Host* host =
      zone->create_host("rank-" + std::string(5 - number.size(), '0') + number, kNsPerSecond);
  host->seal();
  return host;
}

/// Puts hosts into the places of a zone; places from `ranks` on stay empty.
s4u::ClusterCallbacks Places(int ranks) {
  return s4u::ClusterCallbacks(
      [ranks](s4u::NetZone* zone, const std::vector<unsigned long>&, unsigned long place) {
        simgrid::kernel::routing::NetPoint* point =
            place < static_cast<unsigned long>(ranks)
                ? MakeHost(zone, place)->get_netpoint()
                : zone->create_router("empty-" + std::to_string(place));
        return std::pair{point, static_cast<simgrid::kernel::routing::NetPoint*>(nullptr)};
      });
}

/// A torus of two nodes in each dimension: its dimension-order routes are those of e-cube. Each
/// channel carries its full rate in both directions. The host is attached to node 0.
void Hypercube(const MachineRow& machine, s4u::NetZone* root, int nodes, bool host) {
  std::vector<unsigned long> dimensions{2};
  for (int room = 2; room < nodes; room *= 2) dimensions.push_back(2);
  s4u::NetZone* cube =
      s4u::create_torus_zone("cube", root, dimensions, Places(nodes), machine.bytes_per_second,
                             machine.hop_s, s4u::Link::SharingPolicy::SPLITDUPLEX);
  cube->seal();
  if (!host) return;
  s4u::NetZone* outside = s4u::create_full_zone("outside")->set_parent(root);
  const s4u::Host* the_host = MakeHost(outside, static_cast<unsigned long>(nodes));
  outside->seal();
  s4u::Link* cable = root->create_split_duplex_link("cable", machine.bytes_per_second);
  cable->set_latency(machine.hop_s)->seal();
  root->add_route(cube->get_netpoint(), outside->get_netpoint(),
                  s4u::Host::by_name("rank-00000")->get_netpoint(), the_host->get_netpoint(),
                  {{cable, s4u::LinkInRoute::Direction::UP}}, true);
}

/// Three levels of switches without bottleneck: 17 places at a switch, 8 x 8 of those.
void FatTree(const MachineRow& machine, s4u::NetZone* root, int nodes, bool host) {
  const s4u::FatTreeParams levels(3, {17, 8, 8}, {1, 17, 8}, {1, 1, 1});
  s4u::create_fatTree_zone("tree", root, levels, Places(nodes + (host ? 1 : 0)),
                           machine.bytes_per_second, machine.hop_s,
                           s4u::Link::SharingPolicy::SPLITDUPLEX)
      ->seal();
}

// Start-up on the iPSC: the exemplar gives about 270 us, nearly all of it software, split evenly; a
// message of more than 100 bytes waits for a buffer first and is taken to cost 1.89 times as much;
// the difference is the sender's. docs/stipple-simulate.md gives the reasons.
constexpr StartUp kIpsc2Send{135'000, 375'000}, kIpsc2Receive{135'000, 135'000};
constexpr StartUp kIpsc860Send{45'000, 125'000}, kIpsc860Receive{45'000, 45'000};
constexpr StartUp kModernSend{250, 250}, kModernReceive{250, 250};

// docs/stipple-simulate.md says where prices come from.
constexpr Prices kModernPrices{4'150, 9'700, 90'000, 78'000};
constexpr Prices kIpsc2Prices{66'000'000, 163'000'000, 420'000'000, 280'000'000};
constexpr Prices kIpsc860Prices{3'000'000, 6'000'000, 19'000'000, 15'000'000};

// Of a node. iPSC/2: the study's nodes had up to 16 MB each. iPSC/860: 8 to 16 MB; the larger one.
// Modern: what is usual for a core, 256 GB in a computer of 64 cores, as prices are those of a
// core.
constexpr std::uint64_t kIpscMemory = std::uint64_t{16} << 20,
                        kModernMemory = std::uint64_t{4} << 30;

constexpr double kMegabyte = 1e6;

constexpr std::array kMachines{
    MachineRow{"ipsc2", "Intel iPSC/2: hypercube of 16 MHz 386/387 nodes, and a host", 128,
               kIpscMemory, true, kIpsc2Prices, kIpsc2Send, kIpsc2Receive, 50e-6, 1e-3,
               2.8 * kMegabyte, 1e-6, Hypercube},
    MachineRow{"ipsc860", "Intel iPSC/860: the same network, 40 MHz i860 nodes, and a host", 128,
               kIpscMemory, true, kIpsc860Prices, kIpsc860Send, kIpsc860Receive, 17e-6, 1e-3,
               2.8 * kMegabyte, 1e-6, Hypercube},
    MachineRow{"modern", "cluster of today: fat tree, 12.5 GB/s a link", 1024, kModernMemory, false,
               kModernPrices, kModernSend, kModernReceive, 100e-9, 250e-9, 12.5e3 * kMegabyte,
               100e-9, FatTree}};

}  // namespace

std::span<const MachineRow> Machines() { return kMachines; }

}  // namespace stipple::simulate
