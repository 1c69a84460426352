// SPDX-License-Identifier: MIT
// How far reading has come: told by the reader, asked by whoever shows it.
#ifndef STIPPLE_ANALYSIS_TRACE_READ_METER_H
#define STIPPLE_ANALYSIS_TRACE_READ_METER_H

#include <atomic>
#include <cstdint>

namespace stipple {

class ReadMeter {
 public:
  struct Reading {
    const char* phase = nullptr;  // "reading"; null: nothing was begun
    std::uint64_t done_bytes = 0;
    std::uint64_t total_bytes = 0;  // 0: nobody can say
  };

  /// `phase` must live as long as the meter.
  void Begin(const char* phase, std::uint64_t total_bytes) {
    done_bytes_ = 0;
    total_bytes_ = total_bytes;
    phase_ = phase;
  }
  void Add(std::uint64_t bytes) { done_bytes_.fetch_add(bytes, std::memory_order_relaxed); }
  Reading Now() const { return {phase_, done_bytes_, total_bytes_}; }

 private:
  std::atomic<const char*> phase_ = nullptr;
  std::atomic<std::uint64_t> done_bytes_ = 0;
  std::atomic<std::uint64_t> total_bytes_ = 0;
};

}  // namespace stipple

#endif
