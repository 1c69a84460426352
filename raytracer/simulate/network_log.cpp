// SPDX-License-Identifier: MIT
// SimGrid 3.32 tells of network actions by a type that it does not publish: NetworkAction. It is an
// Action, which is published, with references to the two hosts behind it. That is taken as given
// for this version alone, and what is found there must be hosts of the machine.
#include "raytracer/simulate/network_log.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <simgrid/kernel/resource/Action.hpp>
#include <simgrid/s4u.hpp>
// Needs what others define first.
#include <simgrid/version.h>

namespace stipple::simulate {
namespace {

namespace s4u = simgrid::s4u;
using simgrid::kernel::resource::Action;
using simgrid::kernel::resource::NetworkAction;

static_assert(SIMGRID_VERSION == 33200,
              "NetworkAction's layout has been looked at for SimGrid 3.32 only");

struct PublishedAction : Action {
  const s4u::Host* from;
  const s4u::Host* to;
};

std::uint64_t Ns(double seconds) { return static_cast<std::uint64_t>(std::llround(seconds * 1e9)); }

void OnChange(NetworkAction& action, Action::State) {
  const auto& seen = reinterpret_cast<const PublishedAction&>(action);
  if (seen.get_state() != Action::State::FINISHED) return;
  NetworkLog::Instance().Note(seen.from, seen.to,
                              {Ns(seen.get_start_time()), Ns(seen.get_finish_time()),
                               static_cast<std::uint64_t>(seen.get_cost()), 0});
}

}  // namespace

NetworkLog& NetworkLog::Instance() {
  static auto* log = new NetworkLog;  // never destroyed: ranks look at it until the process is gone
  return *log;
}

void NetworkLog::Begin() {
  int rank = 0;
  for (const s4u::Host* host : s4u::Engine::get_instance()->get_all_hosts())
    rank_of_[host] = rank++;
  ended_.resize(rank_of_.size());
  s4u::Link::on_communication_state_change_cb(OnChange);
}

void NetworkLog::Note(const s4u::Host* from, const s4u::Host* to, const Transmission& what) {
  const auto sender = rank_of_.find(from);
  const auto receiver = rank_of_.find(to);
  if (sender == rank_of_.end() || receiver == rank_of_.end()) {
    fmt::print(stderr, "stipple simulate: this SimGrid tells of messages in another way\n");
    std::abort();
  }
  Transmission& noted = ended_[static_cast<std::size_t>(sender->second)].emplace_back(what);
  noted.receiver = receiver->second;
}

bool NetworkLog::Take(int rank, Transmission& transmission) {
  if (rank < 0 || static_cast<std::size_t>(rank) >= ended_.size()) return false;
  std::deque<Transmission>& queue = ended_[static_cast<std::size_t>(rank)];
  if (queue.empty()) return false;
  transmission = queue.front();
  queue.pop_front();
  return true;
}

}  // namespace stipple::simulate
