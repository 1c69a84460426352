// SPDX-License-Identifier: MIT
// The code of a compacted chunk: words to bytes and back, exactly the same words. Each chunk stands
// for itself.
//
// Most of a trace can be foretold. An event needs its distance in time from the one before, a byte
// or two; a leave is nearly always that of the innermost open function; an enter is nearly always
// that of the function which followed the same sibling in the same parent the last time. So an
// event becomes an operation (one byte), the bytes of its distance, and seldom a region.
// Operations, distances and regions stand in columns, each alike in itself, and zstd takes what
// repeats.
//
// Coder and decoder keep the same model of the thread: open functions, the last time, what was
// foretold. It begins empty with each chunk: leaves of functions entered before name their region.
#ifndef STIPPLE_ANALYSIS_TRACE_CHUNK_CODE_H
#define STIPPLE_ANALYSIS_TRACE_CHUNK_CODE_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stipple/format.h"

namespace stipple {

/// Functions that are open, each with its last child, and what was entered where last time.
class CallModel {
 public:
  void Begin(std::size_t words);
  std::size_t depth() const { return depth_; }
  std::uint32_t top() const { return frames_[depth_].region; }
  /// Of the next function to be entered.
  std::uint32_t& Guess() {
    const Frame& f = frames_[depth_];
    return guesses_[(f.region * 0x9E3779B1U + f.last_child * 0x85EBCA6BU) >> kGuessShift];
  }
  void Enter(std::uint32_t region) { frames_[++depth_] = {region, 0}; }
  void Leave(std::uint32_t region) {
    if (depth_ != 0) --depth_;
    frames_[depth_].last_child = region;
  }

 private:
  static constexpr int kGuessShift = 20;
  struct Frame {
    std::uint32_t region;
    std::uint32_t last_child;
  };
  std::vector<Frame> frames_;  // [0]: outside of all
  std::size_t depth_ = 0;
  std::vector<std::uint32_t> guesses_;
};

struct CodedChunk {
  std::string frame;         // empty: the words cannot be coded
  std::uint64_t events = 0;  // function events and closed records
};

class ChunkCoder {
 public:
  ChunkCoder();
  ~ChunkCoder();
  /// Codes the words, of which those behind the last that is not zero are left out.
  CodedChunk Code(std::span<const EventWord> words);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class ChunkDecoder {
 public:
  ChunkDecoder();
  ChunkDecoder(ChunkDecoder&&) noexcept;
  ChunkDecoder& operator=(ChunkDecoder&&) noexcept;
  ~ChunkDecoder();
  /// Fills all of `words` from a frame. False: the frame is damaged.
  bool Decode(std::span<const std::byte> frame, std::span<EventWord> words);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace stipple

#endif
