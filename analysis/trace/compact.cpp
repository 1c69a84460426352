// SPDX-License-Identifier: MIT
// A stream is read as for any other purpose, so what is compacted is what every reader sees: each
// chunk once, in order. Definitions are copied, events are coded chunk by chunk on all cores, and
// each coded chunk is decoded again and compared before it counts: one that would not come back
// word by word, or would not become smaller, is copied as it is.
//
// A stream with damaged headers or chunks is left alone: its reader has to guess, and a compacted
// guess could not be told from the truth. Words inside a chunk may be what they will, they come
// back.
#include "analysis/trace/compact.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <span>

#include "analysis/trace/chunk_code.h"
#include "analysis/trace/gaps.h"
#include "analysis/trace/input_error.h"
#include "analysis/trace/parallel.h"
#include "analysis/trace/stream.h"
#include "analysis/trace/writer.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBatchChunks = 128;
// Above this the chunks of one stream are work for all cores, below it streams are.
constexpr std::uint64_t kLargeStreamBytes = std::uint64_t{64} << 20;

/// A file that takes the place of another one when it is whole, and is gone if it never is.
class NewFile {
 public:
  explicit NewFile(const std::string& path) : path_(path), own_(path + kUnfinishedStream) {}
  ~NewFile() {
    if (file_ < 0) return;
    unlink(own_.c_str());
    close(file_);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// 0 or an errno; EBUSY: somebody else is making it. What a killed one left is replaced.
  int Begin(mode_t mode) {
    const int file = open(own_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, mode);
    if (file < 0) return errno;
    struct stat ours = {};
    struct stat there = {};
    const bool is_ours = flock(file, LOCK_EX | LOCK_NB) == 0 && fstat(file, &ours) == 0 &&
                         stat(own_.c_str(), &there) == 0 && ours.st_ino == there.st_ino;
    if (!is_ours || ftruncate(file, 0) != 0) {
      close(file);
      return EBUSY;
    }
    fchmod(file, mode);
    file_ = file;
    return 0;
  }
  /// 0 or an errno.
  int Write(const void* data, std::size_t bytes) {
    const auto* at = static_cast<const char*>(data);
    written_ += bytes;
    while (bytes != 0) {
      const ssize_t n = write(file_, at, bytes);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return n == 0 ? EIO : errno;
      at += n;
      bytes -= static_cast<std::size_t>(n);
    }
    return 0;
  }
  int Finish() {
    if (fsync(file_) != 0 || rename(own_.c_str(), path_.c_str()) != 0) return errno;
    close(file_);
    file_ = -1;
    return 0;
  }
  std::uint64_t written() const { return written_; }

 private:
  std::string path_;
  std::string own_;
  int file_ = -1;
  std::uint64_t written_ = 0;
};

/// A chunk as it will stand in the file.
struct NewChunk {
  std::string bytes;
  std::uint64_t events = 0;
};

ChunkHeader HeaderOf(const Chunk& chunk) {
  ChunkHeader h;
  std::memcpy(&h, reinterpret_cast<const char*>(chunk.begin) - sizeof(h), sizeof(h));
  return h;
}

std::string PlainBytes(const Chunk& chunk) {
  ChunkHeader h = HeaderOf(chunk);
  h.bytes = static_cast<std::uint32_t>(chunk.Bytes());
  std::string bytes(reinterpret_cast<const char*>(&h), sizeof(h));
  bytes.append(reinterpret_cast<const char*>(chunk.begin),
               static_cast<std::size_t>(chunk.end - chunk.begin) * sizeof(EventWord));
  return bytes;
}

NewChunk MakeChunk(const Chunk& chunk) {
  thread_local ChunkCoder coder;
  thread_local ChunkDecoder decoder;
  thread_local std::vector<EventWord> again;
  const std::span<const EventWord> words(chunk.begin, chunk.end);
  const CodedChunk coded = coder.Code(words);
  again.resize(words.size());
  const bool smaller = coded.frame.size() + sizeof(CompactedChunk) < words.size_bytes();
  if (coded.frame.empty() || !smaller || BeginsWithStep(chunk) ||
      !decoder.Decode(std::as_bytes(std::span(coded.frame)), again) ||
      !std::ranges::equal(again, words))
    return {PlainBytes(chunk), coded.events};
  ChunkHeader h = HeaderOf(chunk);
  const std::size_t bytes = sizeof(h) + sizeof(CompactedChunk) + coded.frame.size();
  h.kind = ChunkKind::kCompacted;
  h.bytes =
      static_cast<std::uint32_t>((bytes + kCompactedAlign - 1) / kCompactedAlign * kCompactedAlign);
  const CompactedChunk compacted{words.size(), coded.frame.size()};
  NewChunk made{std::string(reinterpret_cast<const char*>(&h), sizeof(h)), coded.events};
  made.bytes.append(reinterpret_cast<const char*>(&compacted), sizeof(compacted));
  made.bytes += coded.frame;
  made.bytes.resize(h.bytes);
  return made;
}

/// Why the stream must stay as it is; null: it need not.
const char* Obstacle(const Stream& stream, Writer writer, bool in_place) {
  constexpr std::array kDamage = {Defect::kBadFileHeader, Defect::kTruncatedFile, Defect::kBadChunk,
                                  Defect::kBadTime};
  if (stream.running || (in_place && writer == Writer::kThere))
    return "its process is still running";
  if (in_place && writer == Writer::kUnknown && !stream.end)
    return "its process may still be running on another computer";
  for (const Defect defect : kDamage)
    if (stream.health.CountOf(defect) != 0) return "it is damaged";
  return nullptr;
}

/// One stream on its way.
struct Work {
  std::string from;
  std::string to;
  std::uint64_t bytes = 0;
  std::uint64_t bytes_after = 0;
  std::uint64_t events = 0;
  bool compacted = false;
  bool stopped = false;
  std::string why_not;
};

class Compaction {
 public:
  Compaction(const std::atomic<bool>& stop, ReadMeter* meter) : stop_(stop), meter_(meter) {}

  void Do(Work& work, bool all_cores) const {
    work.bytes_after = work.bytes;
    work.stopped = stop_;
    if (work.stopped) return;
    const bool in_place = work.from == work.to;
    const Writer writer = WriterOf(work.from);
    TraceHealth health;
    const std::unique_ptr<Stream> stream = ReadStream(work.from, health);
    const bool is_compacted = stream != nullptr && IsCompacted(*stream);
    const char* obstacle =
        stream == nullptr ? "it cannot be read" : Obstacle(*stream, writer, in_place);
    if (obstacle != nullptr && !is_compacted) work.why_not = obstacle;
    if (obstacle == nullptr && !is_compacted)
      Rewrite(*stream, work, all_cores);
    else if (!in_place)
      Copy(work);
    if (meter_ != nullptr && !work.compacted) meter_->Add(work.bytes);
  }

 private:
  static bool IsCompacted(const Stream& stream) {
    return (stream.header.features & static_cast<std::uint64_t>(Feature::kCompacted)) != 0;
  }

  static void Copy(Work& work) {
    std::error_code error;
    fs::copy_file(work.from, work.to, error);
    if (error) work.why_not = error.message();
  }

  void Rewrite(const Stream& stream, Work& work, bool all_cores) const {
    struct stat status = {};
    stat(work.from.c_str(), &status);
    NewFile file(work.to);
    int error = file.Begin(status.st_mode & 07777);
    if (error == 0) error = WriteStart(stream, file);
    if (error == 0) error = CopyChunks(stream.definitions, file);
    for (const ThreadStream& t : stream.threads)
      if (error == 0) error = CopyChunks(t.kernel, file);
    std::vector<const Chunk*> chunks;
    for (const ThreadStream& t : stream.threads)
      for (const Chunk& c : t.chunks) chunks.push_back(&c);
    for (std::size_t i = 0; error == 0 && i < chunks.size(); i += kBatchChunks) {
      const std::size_t count = std::min(kBatchChunks, chunks.size() - i);
      error = WriteBatch({&chunks[i], count}, file, work, all_cores);
    }
    if (error == 0) error = file.Finish();
    work.stopped = error == ECANCELED;
    work.compacted = error == 0;
    if (error == 0) work.bytes_after = file.written();
    if (error != 0 && !work.stopped)
      work.why_not = error == EBUSY ? "somebody else compacts it" : std::strerror(error);
  }

  /// As they are.
  static int CopyChunks(std::span<const Chunk> chunks, NewFile& file) {
    int error = 0;
    for (std::size_t i = 0; error == 0 && i < chunks.size(); ++i) {
      const std::string bytes = PlainBytes(chunks[i]);
      error = file.Write(bytes.data(), bytes.size());
    }
    return error;
  }

  static int WriteStart(const Stream& stream, NewFile& file) {
    FileHeader header = stream.header;
    header.features |= static_cast<std::uint64_t>(Feature::kCompacted);
    std::array<char, kFirstCompactedByte> start{};
    std::memcpy(start.data(), &header, sizeof(header));
    return file.Write(start.data(), start.size());
  }

  int WriteBatch(std::span<const Chunk* const> chunks, NewFile& file, Work& work,
                 bool all_cores) const {
    std::vector<NewChunk> made(chunks.size());
    const auto make = [&](std::size_t i) {
      if (stop_) return;
      made[i] = MakeChunk(*chunks[i]);
      if (meter_ != nullptr) meter_->Add(chunks[i]->Bytes());
    };
    if (all_cores)
      ForEachIndex(chunks.size(), make);
    else
      for (std::size_t i = 0; i < chunks.size(); ++i) make(i);
    if (stop_) return ECANCELED;
    int error = 0;
    for (std::size_t i = 0; error == 0 && i < made.size(); ++i) {
      work.events += made[i].events;
      error = file.Write(made[i].bytes.data(), made[i].bytes.size());
    }
    return error;
  }

  const std::atomic<bool>& stop_;
  ReadMeter* meter_;
};

/// The streams of the archive, the largest first.
std::vector<Work> StreamsOf(const std::string& from, const std::string& to) {
  std::error_code error;
  if (!fs::is_directory(from, error))
    throw InputError(from, "is not an archive (no such directory)");
  std::vector<Work> streams;
  for (const fs::directory_entry& entry : fs::directory_iterator(from, error)) {
    if (entry.path().extension() != ".stream") continue;
    Work work;
    work.from = entry.path();
    work.to = from == to ? work.from : (fs::path(to) / entry.path().filename()).string();
    work.bytes = entry.file_size(error);
    streams.push_back(std::move(work));
  }
  std::ranges::sort(streams, [](const Work& a, const Work& b) {
    return std::pair(b.bytes, a.from) < std::pair(a.bytes, b.from);
  });
  return streams;
}

/// Removes what killed compactions left.
void RemoveUnfinished(const std::string& directory) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() != kUnfinishedStream) continue;
    const int file = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) continue;
    if (flock(file, LOCK_EX | LOCK_NB) == 0) unlink(entry.path().c_str());
    close(file);
  }
}

void FlushDirectory(const std::string& path) {
  const int directory = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return;
  fsync(directory);
  close(directory);
}

}  // namespace

CompactResult CompactArchive(const std::string& from, const std::string& to,
                             const std::atomic<bool>& stop, ReadMeter* meter) {
  std::vector<Work> streams = StreamsOf(from, to);
  RemoveUnfinished(to);
  std::uint64_t bytes = 0;
  for (const Work& w : streams) bytes += w.bytes;
  if (meter != nullptr) meter->Begin("compacting", bytes);
  const Compaction compaction(stop, meter);
  const auto small = std::ranges::partition_point(
      streams, [](const Work& w) { return w.bytes >= kLargeStreamBytes; });
  for (auto w = streams.begin(); w != small; ++w) compaction.Do(*w, true);
  ForEachIndex(static_cast<std::size_t>(streams.end() - small),
               [&](std::size_t i) { compaction.Do(small[static_cast<std::ptrdiff_t>(i)], false); });
  FlushDirectory(to);
  CompactResult result;
  for (Work& w : streams) {
    result.bytes_before += w.bytes;
    result.bytes_after += w.bytes_after;
    result.events += w.compacted ? w.events : 0;
    result.event_bytes += w.compacted ? w.bytes_after : 0;
    result.streams += w.compacted ? 1 : 0;
    result.stopped = result.stopped || w.stopped;
    if (!w.why_not.empty()) result.left_alone.push_back({fs::path(w.from).filename(), w.why_not});
  }
  return result;
}

}  // namespace stipple
