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

/// Functions that are open, what the innermost of them called last, and what was entered where last
/// time. A light hand on the memory of CallMemory, so that a loop can keep it in registers: each
/// event waits for the one before it, so what it needs of that one must be at hand.
class CallModel {
 public:
  /// `open`: [-1] and [0] stand for what is outside of all.
  CallModel(std::uint32_t* open, std::uint32_t* guesses) : open_(open), guesses_(guesses) {}

  std::size_t depth() const { return depth_; }
  std::uint32_t top() const { return top_; }
  /// Of the next function to be entered.
  std::uint32_t& Guess() const {
    return guesses_[(top_ * 0x9E3779B1U + last_child_ * 0x85EBCA6BU) >> 20];
  }
  void Enter(std::uint32_t region) {
    open_[++depth_] = top_ = region;
    last_child_ = 0;
  }
  void Leave(std::uint32_t region) {
    if (depth_ != 0) --depth_;
    top_ = open_[depth_];
    last_child_ = region;
  }
  /// Leaves the top, which there is, or enters `named`, if it is, or else what was guessed; the
  /// region. `leaves` and `names` are masks, all ones or 0, and so is `named` where it is not.
  /// Without a branch, for nobody can foretell which of these comes: of a choice between two values
  /// the compiler may make one after all.
  std::uint32_t Step(std::uint32_t leaves, std::uint32_t names, std::uint32_t named) {
    const std::uint32_t below = open_[static_cast<std::ptrdiff_t>(depth_) - 1];
    std::uint32_t& guess = Guess();
    const std::uint32_t entered = (guess & ~names) | named;  // `names` is 0 at a leave
    const std::uint32_t region = (entered & ~leaves) | (top_ & leaves);
    guess = entered;
    top_ = (entered & ~leaves) | (below & leaves);
    last_child_ = region & leaves;
    depth_ += 1 - 2 * static_cast<std::size_t>(leaves & 1);
    open_[depth_] = top_;
    return region;
  }

  static constexpr std::size_t kPlaces = 4096;

 private:
  std::uint32_t* open_;
  std::uint32_t* guesses_;
  std::size_t depth_ = 0;
  std::uint32_t top_ = 0;
  std::uint32_t last_child_ = 0;
};

class CallMemory {
 public:
  /// A model that knows nothing yet, for so many words.
  CallModel Begin(std::size_t words);

 private:
  std::vector<std::uint32_t> open_;
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
