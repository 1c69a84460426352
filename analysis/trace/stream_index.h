// SPDX-License-Identifier: MIT
// What opening a stream finds by walking through the file, as bytes for the index: where chunks
// are, what their headers say, and what is wrong with them. Opened again, a file of 64 000 chunks
// is not touched but for its header and its definitions.
#ifndef STIPPLE_ANALYSIS_TRACE_STREAM_INDEX_H
#define STIPPLE_ANALYSIS_TRACE_STREAM_INDEX_H

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trace/bytes.h"
#include "analysis/trace/index_file.h"
#include "analysis/trace/stream.h"

namespace stipple {

void PutHealth(const TraceHealth& health, ByteWriter& to);
TraceHealth GetHealth(ByteReader& from);

/// Of each stream file, in order, what the index holds; empty: nothing. Null: there is no index.
std::vector<std::string_view> SavedStreams(const IndexFile* index, std::size_t files);

/// Of a stream that no process writes.
std::string SavedStream(const Stream& stream);

/// Takes the chunks from `saved` into a stream of which only the file is known. False: they do not
/// fit the file.
bool LoadChunks(ByteReader& saved, Stream& stream);
/// And then, when the definitions have been read, the rest.
bool LoadFindings(ByteReader& saved, Stream& stream);

}  // namespace stipple

#endif
