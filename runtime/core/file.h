// SPDX-License-Identifier: MIT
// The stream file of a process: made once, grown by extents, handed out chunk by chunk.
#ifndef STIPPLE_RUNTIME_CORE_FILE_H
#define STIPPLE_RUNTIME_CORE_FILE_H

#include <cstddef>
#include <cstdint>

#include "runtime/core/line.h"

namespace stipple {

inline constexpr std::size_t kPathBytes = 4400;

/// Lies in memory that a forked child finds zeroed; zero is "no file".
struct StreamFile {
  int descriptor;
  std::uint64_t device;  // with inode: the file that is meant, should the program close our
  std::uint64_t inode;   // descriptor and the number be given to another file
  std::uint64_t used;    // bytes handed out
  std::uint64_t allocated;
  char* window;  // where the file is mapped from window_begin to window_end
  std::uint64_t window_begin;
  std::uint64_t window_end;
  std::uint64_t next_extent_bytes;
  std::uint64_t ahead_limit;  // no extents ahead of need beyond this; 0: none
  bool closing;               // no more extents ahead of need
  Line<kPathBytes> path;
};

/// Creates ARCHIVE/HOSTNAME.PID.START.stream; 0 or an errno.
int CreateFile(StreamFile& file, const char* archive, const char* host_name, std::uint32_t pid,
               std::uint64_t start_ns);

/// Takes the next `bytes` (a multiple of kGranuleBytes) of the file, mapped and zero; null and an
/// errno in `error` when the file cannot grow. The lock is held.
char* TakeBytes(StreamFile& file, std::size_t bytes, int* error);

/// The same without a mapping: false and an errno when the file cannot grow.
bool TakePlace(StreamFile& file, std::size_t bytes, std::uint64_t* offset, int* error);

/// Writes into bytes taken before, at `offset`; 0 or an errno.
int WriteBytes(StreamFile& file, std::uint64_t offset, const char* from, std::size_t bytes);

/// Cuts off what was allocated ahead; from now on the file grows only by what is taken.
void TrimFile(StreamFile& file);

}  // namespace stipple

#endif
