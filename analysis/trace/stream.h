// SPDX-License-Identifier: MIT
// One stream file: what one process recorded. Maps the file read-only and finds its chunks and
// definitions; any bytes are safe. Events stay in the mapping and are read by scan.h.
#ifndef STIPPLE_ANALYSIS_TRACE_STREAM_H
#define STIPPLE_ANALYSIS_TRACE_STREAM_H

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trace/health.h"
#include "stipple/format.h"

namespace stipple {

/// Times from here on are damage. Differences of sound ones fit a signed number.
inline constexpr std::uint64_t kMostTicks = std::uint64_t{1} << 62;

/// A file in memory, read-only.
class MappedFile {
 public:
  /// Empty when the file cannot be opened or mapped.
  static std::optional<MappedFile> Open(const std::string& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  std::span<const std::byte> bytes() const { return {data_, bytes_}; }

 private:
  MappedFile(const std::byte* data, std::size_t bytes) : data_(data), bytes_(bytes) {}
  const std::byte* data_;
  std::size_t bytes_;
};

/// The words of one chunk, and what its header says.
struct Chunk {
  const EventWord* begin = nullptr;
  const EventWord* end = nullptr;
  std::uint64_t sequence = 0;
  std::uint64_t ticks = 0;
  std::uint64_t raw_ns = 0;
  std::uint64_t lost = 0;
  std::uint32_t thread = 0;
  std::uint32_t tid = 0;
  // Compacted: the words are not here, ChunkWords (scan.h) decodes them.
  std::span<const std::byte> code;
  std::uint64_t coded_words = 0;

  /// As they lie in the file.
  std::uint64_t Bytes() const {
    if (!code.empty()) return sizeof(ChunkHeader) + sizeof(CompactedChunk) + code.size();
    return static_cast<std::uint64_t>(end - begin) * sizeof(EventWord) + sizeof(ChunkHeader);
  }
};

/// What opening an archive finds out about a thread by looking at its events.
struct ThreadFacts {
  std::uint64_t first_ticks = 0;
  std::uint64_t last_ticks = 0;
  double lost_switches = 0;      // that the kernel's ring had no room for
  std::uint64_t has_events = 0;  // of its own or of the kernel
};

/// Event chunks of one thread, in order.
struct ThreadStream {
  std::uint32_t thread = 0;
  std::uint32_t tid = 0;
  std::string name;
  std::vector<Chunk> chunks;
  std::uint64_t end_limit = kMostTicks;  // no event of the last chunk is later
  std::vector<Chunk> kernel;             // what the kernel told of it (kernel.h), in order
  std::optional<ThreadFacts> facts;

  std::uint64_t Bytes() const {
    std::uint64_t bytes = 0;
    for (const Chunk& c : chunks) bytes += c.Bytes();
    return bytes;
  }
};

/// Definitions as the process wrote them, with its own numbers; text lies in the mapping.
struct RegionDefinition {
  std::uint32_t region = 0;
  RegionKind kind = RegionKind::kFunction;
  std::uint32_t line = 0;
  std::string_view linkage_name;
  std::string_view file;
};
struct NameDefinition {
  std::uint32_t name = 0;
  std::string_view text;
  std::string_view unit;
};
struct ChannelDefinition {
  std::uint32_t channel = 0;
  std::string_view name;
};
struct CommunicatorDefinition {
  std::uint32_t communicator = 0;
  std::uint32_t parent = 0;
  std::uint32_t creation = 0;
  std::vector<std::int32_t> world_ranks;
};
/// A file whose functions are known by address.
struct ModuleDefinition {
  std::uint32_t module = 0;
  std::string_view path;
  std::string_view build_id;  // bytes
};
/// Where the function of a region lies.
struct CodeDefinition {
  std::uint32_t region = 0;
  std::uint32_t module = 0;
  std::uint64_t offset = 0;
};
/// What the run-time filter did.
struct FilterUse {
  std::string_view path;  // empty: there was none
  std::uint64_t functions = 0;
  std::uint64_t filtered = 0;
};
/// Visits of a region by a thread since its last sample of it, without any event.
struct VisitCount {
  std::uint32_t region = 0;
  std::uint32_t thread = 0;
  std::uint64_t visits = 0;
};
struct AvailabilityDefinition {
  std::string_view what;
  bool available = false;
  std::int32_t error = 0;
};

/// Events that were lost between two times of their process.
struct LostSpan {
  std::uint64_t from_ticks = 0;
  std::uint64_t to_ticks = 0;
  std::uint64_t events = 0;
};

/// Ticks and CLOCK_MONOTONIC_RAW that were read together.
struct ClockPair {
  std::uint64_t ticks = 0;
  std::uint64_t raw_ns = 0;
};

/// One process's stream.
struct Stream {
  explicit Stream(MappedFile mapped) : file(std::move(mapped)) {}

  MappedFile file;
  std::deque<MappedFile> later;  // of a running process: again, when it had grown
  std::string file_name;
  FileHeader header = {};
  std::string boot_id, host_name, program, settings, command_line;
  std::vector<ThreadStream> threads;  // by thread index

  std::vector<RegionDefinition> regions;
  std::vector<NameDefinition> names;
  std::vector<ChannelDefinition> channels;
  std::vector<CommunicatorDefinition> communicators;
  std::vector<ClockSync> syncs;
  std::vector<AvailabilityDefinition> availability;
  std::vector<ModuleDefinition> modules;
  std::vector<CodeDefinition> code;
  std::deque<std::string> symbol_texts;  // what the files of code said; regions refer to them
  std::vector<Switched> switches;
  FilterUse filter;
  std::vector<VisitCount> visit_counts;
  std::optional<Calibration> calibration;
  std::optional<DefineWorld> world;
  std::optional<ProcessEnd> end;
  bool is_host = false;
  std::uint64_t lost = 0;  // events that the process could not record
  std::vector<Loss> loss_records;
  std::vector<LostSpan> losses;          // all of `lost`
  std::vector<Overwritten> overwritten;  // by a ring, of each thread
  std::vector<ClockPair> clock_pairs;
  std::vector<Chunk> definitions;
  bool running = false;                       // when it was read; then `end` is not set
  std::deque<std::vector<EventWord>> copies;  // of chunks that its process still writes

  TraceHealth health;
};

/// Reads headers and definitions. Null when the file cannot be read or needs a newer reader, with
/// the reason in `health`.
std::unique_ptr<Stream> ReadStream(const std::string& path, TraceHealth& health);
/// The same with what an index holds of it (stream_index.h). Null: that does not fit.
std::unique_ptr<Stream> ReadIndexedStream(const std::string& path, std::string_view saved);

}  // namespace stipple

#endif
