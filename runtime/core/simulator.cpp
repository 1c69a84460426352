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

std::uint64_t SendNs(std::uint64_t bytes) {
  return simulator == nullptr ? 0 : simulator->send_ns(bytes);
}

std::uint64_t ReceiveNs(std::uint64_t bytes) {
  return simulator == nullptr ? 0 : simulator->receive_ns(bytes);
}

bool NextTransmission(NetworkTime& time) {
  stipple_transmission next{};
  if (simulator == nullptr || simulator->next_transmission(&next) == 0) return false;
  time = {next.begin_ns, next.end_ns, next.bytes, next.receiver};
  return true;
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
