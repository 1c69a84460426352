// SPDX-License-Identifier: MIT
// Writes archives word by word, under a clock that the test controls.
#ifndef STIPPLE_TESTS_ANALYSIS_ARCHIVE_WRITER_H
#define STIPPLE_TESTS_ANALYSIS_ARCHIVE_WRITER_H

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "stipple/format.h"

namespace stipple::testing {

/// Chunks of one kind and thread; a new one is begun when the last is full, or on demand.
class ChunkWriter {
 public:
  ChunkWriter(ChunkKind kind, std::uint32_t thread, double ticks_per_ns)
      : kind_(kind), thread_(thread), ticks_per_ns_(ticks_per_ns) {}

  void Begin(std::uint64_t ticks) {
    chunks_.emplace_back(kGranuleBytes / 8, 0);
    ChunkHeader h{kChunkMagic,
                  kGranuleBytes,
                  kind_,
                  thread_,
                  100 + thread_,
                  chunks_.size() - 1,
                  ticks,
                  static_cast<std::uint64_t>(static_cast<double>(ticks) / ticks_per_ns_),
                  0,
                  0};
    std::memcpy(chunks_.back().data(), &h, sizeof(h));
    used_ = sizeof(h) / 8;
  }
  void Add(const void* data, std::size_t bytes, std::uint64_t ticks) {
    if (chunks_.empty() || used_ + (bytes + 7) / 8 > chunks_.back().size()) Begin(ticks);
    std::memcpy(chunks_.back().data() + used_, data, bytes);
    used_ += (bytes + 7) / 8;
  }
  const std::vector<std::vector<std::uint64_t>>& chunks() const { return chunks_; }

 private:
  ChunkKind kind_;
  std::uint32_t thread_;
  double ticks_per_ns_;
  std::size_t used_ = 0;
  std::vector<std::vector<std::uint64_t>> chunks_;
};

/// The stream of one process. One tick is one nanosecond unless told otherwise.
class StreamWriter {
 public:
  explicit StreamWriter(std::uint32_t pid, std::string_view boot_id = "boot-a",
                        double ticks_per_ns = 1)
      : ticks_per_ns_(ticks_per_ns),
        definitions_(ChunkKind::kDefinitions, 0, ticks_per_ns),
        events_{ChunkWriter(ChunkKind::kEvents, 0, ticks_per_ns)},
        kernel_(ChunkKind::kKernel, 0, ticks_per_ns) {
    header.magic = kFileMagic;
    header.version = header.minimum_reader_version = kFormatVersion;
    header.pid = pid;
    header.parent_pid = 1;
    header.start_realtime_ns = 1'000'000'000 + pid;
    header.start_ticks = 1000;
    header.start_raw_ns = static_cast<std::uint64_t>(1000 / ticks_per_ns);
    header.clock = ClockKind::kTsc;
    Copy(header.boot_id, boot_id);
    Copy(header.host_name, "computer");
    Copy(header.program, "/bin/program");
    Copy(header.settings, "clock=exact");
  }

  template <class Record>
  void Define(Record record, std::string text = {}) {
    text.resize((text.size() + 7) / 8 * 8);
    record.header = MakeHeader(Record::kKind, (sizeof(Record) + text.size()) / 8, true);
    std::string bytes(sizeof(Record), '\0');
    std::memcpy(bytes.data(), &record, sizeof(Record));
    bytes += text;
    definitions_.Add(bytes.data(), bytes.size(), header.start_ticks);
  }
  void Region(std::uint32_t id, const std::string& name, RegionKind kind = RegionKind::kFunction,
              std::uint32_t line = 0) {
    const std::string file = kind == RegionKind::kMpi ? "" : "file.cpp";
    Define(DefineRegion{0, id, kind, line, static_cast<std::uint32_t>(name.size()),
                        static_cast<std::uint32_t>(file.size()), 0},
           name + file);
  }
  void World(std::int32_t rank, std::int32_t size) {
    Define(DefineWorld{0, rank, size});
    std::string ranks;
    for (std::int32_t r = 0; r < size; ++r) ranks.append(reinterpret_cast<const char*>(&r), 4);
    Define(DefineCommunicator{0, 1, 0, 0, size}, ranks);
  }
  void Name(std::uint32_t id, const std::string& name, const std::string& unit = "") {
    Define(DefineName{0, id, static_cast<std::uint32_t>(name.size()),
                      static_cast<std::uint32_t>(unit.size()), 0},
           name + unit);
  }
  void End(std::uint64_t ticks) {
    Define(ProcessEnd{
        0, ticks, static_cast<std::uint64_t>(static_cast<double>(ticks) / ticks_per_ns_), 0, 1, 0});
  }

  void Enter(std::uint32_t region, std::uint64_t ticks) { Event(region, false, ticks); }
  void Leave(std::uint32_t region, std::uint64_t ticks) { Event(region, true, ticks); }
  /// An event whose clock was not read.
  void Unclocked(std::uint32_t region, bool leave) {
    const EventWord word = MakeEvent(0, leave, RegionId{region});
    events_.back().Add(&word, 8, last_);
  }
  void Word(EventWord word) { events_.back().Add(&word, 8, last_); }
  template <class Record>
  void Append(Record record) {
    record.header = MakeHeader(Record::kKind, sizeof(Record) / 8, true);
    events_.back().Add(&record, sizeof(Record), last_ = record.ticks);
  }
  /// What the kernel told of the first thread; the record's times are nanoseconds.
  template <class Record>
  void Kernel(Record record) {
    record.header = MakeHeader(Record::kKind, sizeof(Record) / 8, true);
    kernel_.Add(&record, sizeof(Record), header.start_ticks);
  }
  void NewChunk(std::uint64_t ticks) { events_.back().Begin(last_ = ticks); }
  /// What follows belongs to a new thread.
  void NewThread() {
    events_.emplace_back(ChunkKind::kEvents, static_cast<std::uint32_t>(events_.size()),
                         ticks_per_ns_);
  }

  std::string Bytes() const {
    std::string bytes(kGranuleBytes, '\0');
    std::memcpy(bytes.data(), &header, sizeof(header));
    const auto add = [&bytes](const ChunkWriter& writer) {
      for (const auto& chunk : writer.chunks())
        bytes.append(reinterpret_cast<const char*>(chunk.data()), chunk.size() * 8);
    };
    add(definitions_);
    for (const ChunkWriter& writer : events_) add(writer);
    add(kernel_);
    return bytes;
  }

  FileHeader header = {};

 private:
  template <std::size_t N>
  static void Copy(char (&to)[N], std::string_view from) {
    std::memcpy(to, from.data(), from.size() < N ? from.size() : N - 1);
  }
  void Event(std::uint32_t region, bool leave, std::uint64_t ticks) {
    const EventWord word = MakeEvent(ticks, leave, RegionId{region});
    events_.back().Add(&word, 8, last_ = ticks);
  }

  double ticks_per_ns_;
  std::uint64_t last_ = 0;  // where a chunk begins whose first word has no time
  ChunkWriter definitions_;
  std::vector<ChunkWriter> events_;
  ChunkWriter kernel_;
};

/// A directory that is gone at the end of the test.
class TemporaryArchive {
 public:
  TemporaryArchive() {
    std::string name = std::filesystem::temp_directory_path() / "stipple-test-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~TemporaryArchive() { std::filesystem::remove_all(path_); }
  TemporaryArchive(const TemporaryArchive&) = delete;
  TemporaryArchive& operator=(const TemporaryArchive&) = delete;

  void Add(const StreamWriter& stream) {
    AddBytes(std::to_string(stream.header.pid), stream.Bytes());
  }
  void AddBytes(const std::string& name, std::string_view bytes) {
    std::ofstream file(path_ + "/computer." + name + ".1.stream", std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace stipple::testing

#endif
