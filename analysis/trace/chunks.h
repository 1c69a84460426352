// SPDX-License-Identifier: MIT
// Where the chunks of a stream file are: of one that nobody writes any more, and of one that grows
// while it is read.
#ifndef STIPPLE_ANALYSIS_TRACE_CHUNKS_H
#define STIPPLE_ANALYSIS_TRACE_CHUNKS_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/trace/stream.h"

namespace stipple {

/// In the order of the file.
struct FoundChunks {
  std::map<std::uint32_t, ThreadStream> threads;
  std::vector<Chunk> definitions;
};

/// Chunks of a file that stays as it is; what is damaged is told to the stream's health.
FoundChunks FindChunks(Stream& stream);

/// Chunks of events of the file at `path` that is being written, mapped by `stream`: for each
/// thread all that it had committed at one moment, without gaps; the chunks that may still change
/// are copied. False in `whole`: a thread was too fast, and its last chunks are not there.
FoundChunks FindLiveChunks(Stream& stream, const std::string& path, bool& whole);

/// The pages of a chunk that was read need not stay resident; when they are read again they come
/// back.
void ReleaseChunk(const Stream& stream, const Chunk& chunk);

/// Chunks of definitions of a file that is being written; these only grow.
std::vector<Chunk> FindLiveDefinitions(const MappedFile& file);

}  // namespace stipple

#endif
