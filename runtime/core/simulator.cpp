// SPDX-License-Identifier: MIT
#include "runtime/core/simulator.h"

#include "runtime/core/recorder.h"
#include "stipple/user.h"

namespace stipple {

constinit const stipple_simulator* simulator = nullptr;

std::uint64_t SimulatedTicks() { return simulator == nullptr ? 0 : simulator->now_ns(); }

void ChargeEvent() {
  if (simulator != nullptr && simulator->event_ns != 0) simulator->charge(simulator->event_ns);
}

void SettleCharges() {
  if (simulator != nullptr) simulator->settle();
}

void EndSimulation() {
  if (simulator != nullptr) simulator->end();
}

}  // namespace stipple

extern "C" {

void stipple_set_simulator(const struct stipple_simulator* simulator) {
  stipple::simulator = simulator;
}

void stipple_charge_ns(uint64_t ns) {
  if (stipple::simulator != nullptr) stipple::simulator->charge(ns);
}
}
