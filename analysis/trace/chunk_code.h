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

/// Functions that are open, each with its last child, and what was entered where last time. A light
/// hand on the memory of CallMemory, so that a loop can keep it in registers.
class CallModel {
 public:
  struct Frame {
    std::uint32_t region;
    std::uint32_t last_child;
  };
  CallModel(Frame* frames, std::uint32_t* guesses) : frames_(frames), guesses_(guesses) {}

  std::size_t depth() const { return depth_; }
  std::uint32_t top() const { return frames_[depth_].region; }
  /// Of the next function to be entered.
  std::uint32_t& Guess() const { return guesses_[Place(frames_[depth_])]; }
  void Enter(std::uint32_t region) { frames_[++depth_] = {region, 0}; }
  void Leave(std::uint32_t region) {
    if (depth_ != 0) --depth_;
    frames_[depth_].last_child = region;
  }
  /// Leaves the top, which there is, or enters what was guessed; its region. Without a branch, for
  /// nobody can foretell which of the two comes.
  std::uint32_t Step(bool leave) {
    const Frame now = frames_[depth_];
    const std::uint32_t leaves = 0 - static_cast<std::uint32_t>(leave);
    const std::uint32_t guess = guesses_[Place(now)];
    const std::uint32_t region = (now.region & leaves) | (guess & ~leaves);
    depth_ += 1 - 2 * static_cast<std::size_t>(leave);
    Frame& next = frames_[depth_];
    next = {(next.region & leaves) | (region & ~leaves), region & leaves};
    return region;
  }

  static constexpr std::size_t kPlaces = 4096;

 private:
  static std::uint32_t Place(const Frame& f) {
    return (f.region * 0x9E3779B1U + f.last_child * 0x85EBCA6BU) >> 20;
  }
  Frame* frames_;  // [0]: outside of all
  std::uint32_t* guesses_;
  std::size_t depth_ = 0;
};

class CallMemory {
 public:
  /// A model that knows nothing yet, for so many words.
  CallModel Begin(std::size_t words);

 private:
  std::vector<CallModel::Frame> frames_;
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
