// SPDX-License-Identifier: MIT
// When each message was in the network, as SimGrid's model says it.
#ifndef STIPPLE_RAYTRACER_SIMULATE_NETWORK_LOG_H
#define STIPPLE_RAYTRACER_SIMULATE_NETWORK_LOG_H

#include <deque>
#include <map>
#include <vector>

#include "raytracer/simulate/machine.h"

namespace simgrid::s4u {
class Host;
}

namespace stipple::simulate {

class NetworkLog {
 public:
  static NetworkLog& Instance();

  /// From now on every transmission is noted; the hosts are there.
  void Begin();
  void Note(const simgrid::s4u::Host* from, const simgrid::s4u::Host* to, const Transmission& what);
  /// Takes the oldest of those that `rank` sent and that have ended; false if there is none.
  bool Take(int rank, Transmission& transmission);

 private:
  std::map<const simgrid::s4u::Host*, int> rank_of_;
  std::vector<std::deque<Transmission>> ended_;  // by the sender's rank
};

}  // namespace stipple::simulate

#endif
