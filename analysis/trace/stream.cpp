// SPDX-License-Identifier: MIT
#include "analysis/trace/stream.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <mutex>

#include "analysis/trace/chunks.h"
#include "analysis/trace/gaps.h"
#include "analysis/trace/stream_index.h"
#include "analysis/trace/writer.h"

namespace stipple {
namespace {

constexpr auto kKnownFeatures = static_cast<std::uint64_t>(Feature::kCompacted) |
                                static_cast<std::uint64_t>(Feature::kStackSwitches);

// A damaged number must not make tables of millions of entries: numbers are given out one after
// the other, so one far above the count of definitions is damage.
constexpr std::uint32_t kNumberSlack = 1 << 16;

/// Up to the first zero; what would not print, because of damage, is a question mark.
std::string TextOf(const char* text, std::size_t size) {
  std::string out(text, strnlen(text, size));
  std::ranges::replace_if(
      out, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return out;
}

/// A definition chunk's record being read, with bounds.
struct DefinitionReader {
  Stream& stream;

  template <class Record>
  bool Get(std::span<const EventWord> words, Record& record) const {
    if (words.size_bytes() < sizeof(Record)) return false;
    std::memcpy(&record, words.data(), sizeof(Record));
    return true;
  }
  /// The bytes behind the struct, or nothing when `bytes` is more than there are.
  template <class Record>
  std::optional<std::string_view> Text(std::span<const EventWord> words,
                                       std::uint64_t bytes) const {
    if (bytes > words.size_bytes() - sizeof(Record)) return std::nullopt;
    return std::string_view(reinterpret_cast<const char*>(words.data()) + sizeof(Record), bytes);
  }

  bool Region(std::span<const EventWord> words) {
    DefineRegion r;
    if (!Get(words, r)) return false;
    const auto text =
        Text<DefineRegion>(words, std::uint64_t{r.name_bytes} + std::uint64_t{r.file_bytes});
    if (!text || r.region == 0 || r.region > kMaxRegion ||
        r.region > stream.regions.size() * 16 + kNumberSlack)
      return false;
    const auto kind =
        static_cast<std::uint32_t>(r.region_kind) - 1 < 4 ? r.region_kind : RegionKind::kFunction;
    stream.regions.push_back(
        {r.region, kind, r.line, text->substr(0, r.name_bytes), text->substr(r.name_bytes)});
    return true;
  }

  bool Location(std::span<const EventWord> words) {
    DefineLocation d;
    if (!Get(words, d)) return false;
    const auto text = Text<DefineLocation>(words, d.name_bytes);
    if (!text) return false;
    for (ThreadStream& t : stream.threads)
      if (t.thread == d.thread) t.name = *text;
    return true;
  }

  bool Name(std::span<const EventWord> words) {
    DefineName d;
    if (!Get(words, d)) return false;
    const auto text =
        Text<DefineName>(words, std::uint64_t{d.name_bytes} + std::uint64_t{d.unit_bytes});
    if (!text || d.name > stream.names.size() * 16 + kNumberSlack) return false;
    stream.names.push_back({d.name, text->substr(0, d.name_bytes), text->substr(d.name_bytes)});
    return true;
  }

  bool Channel(std::span<const EventWord> words) {
    DefineChannel d;
    if (!Get(words, d)) return false;
    const auto text = Text<DefineChannel>(words, d.name_bytes);
    if (!text || d.channel > stream.channels.size() * 16 + kNumberSlack) return false;
    stream.channels.push_back({d.channel, *text});
    return true;
  }

  bool World(std::span<const EventWord> words) {
    DefineWorld d;
    if (!Get(words, d) || d.world_rank < 0 || d.world_rank >= d.world_size ||
        d.world_size > (1 << 24))
      return false;
    stream.world = d;
    return true;
  }

  bool Communicator(std::span<const EventWord> words) {
    DefineCommunicator d;
    if (!Get(words, d) || d.size < 0) return false;
    const auto text =
        Text<DefineCommunicator>(words, std::uint64_t{4} * static_cast<unsigned>(d.size));
    if (!text || d.communicator > stream.communicators.size() * 16 + kNumberSlack) return false;
    CommunicatorDefinition c{d.communicator, d.parent, d.creation, {}};
    c.world_ranks.resize(static_cast<std::size_t>(d.size));
    std::memcpy(c.world_ranks.data(), text->data(), text->size());
    stream.communicators.push_back(std::move(c));
    return true;
  }

  bool Sync(std::span<const EventWord> words) {
    ClockSync d;
    if (!Get(words, d) || d.local_ticks >= kMostTicks || d.remote_ticks >= kMostTicks) return false;
    stream.syncs.push_back(d);
    return true;
  }

  bool Lost(std::span<const EventWord> words) {
    Loss d;
    if (!Get(words, d)) return false;
    stream.lost = std::max(stream.lost, d.events);
    if (d.from_ticks < kMostTicks) stream.loss_records.push_back(d);
    return true;
  }

  bool End(std::span<const EventWord> words) {
    ProcessEnd d;
    if (!Get(words, d) || d.ticks >= kMostTicks) return false;
    stream.end = d;
    stream.lost = std::max(stream.lost, d.lost);
    stream.clock_pairs.push_back({d.ticks, d.raw_ns});
    return true;
  }

  bool Visits(std::span<const EventWord> words) {
    VisitCounts d;
    if (!Get(words, d) || d.entries > words.size()) return false;
    const auto text = Text<VisitCounts>(words, d.entries * 16);
    if (!text) return false;
    for (std::uint64_t i = 0; i < d.entries; ++i) {
      VisitCount count;
      static_assert(sizeof(count) == 16);
      std::memcpy(&count, text->data() + i * 16, 16);
      stream.visit_counts.push_back(count);
    }
    return true;
  }

  bool Calibrated(std::span<const EventWord> words) {
    Calibration d;
    if (!Get(words, d)) return false;
    stream.calibration = d;
    return true;
  }

  bool Available(std::span<const EventWord> words) {
    Availability d;
    if (!Get(words, d)) return false;
    const auto text = Text<Availability>(words, d.what_bytes);
    if (!text) return false;
    stream.availability.push_back({*text, d.available == 1, d.error});
    return true;
  }

  bool Command(std::span<const EventWord> words) {
    CommandLine d;
    if (!Get(words, d)) return false;
    const auto text = Text<CommandLine>(words, d.text_bytes);
    if (!text) return false;
    stream.command_line = *text;
    return true;
  }

  bool Module(std::span<const EventWord> words) {
    DefineModule d;
    if (!Get(words, d)) return false;
    const auto text =
        Text<DefineModule>(words, std::uint64_t{d.path_bytes} + std::uint64_t{d.build_id_bytes});
    if (!text) return false;
    stream.modules.push_back({d.module, text->substr(0, d.path_bytes), text->substr(d.path_bytes)});
    return true;
  }

  bool Code(std::span<const EventWord> words) {
    DefineCode d;
    if (!Get(words, d)) return false;
    stream.code.push_back({d.region, d.module, d.offset});
    return true;
  }

  bool Switch(std::span<const EventWord> words) {
    Switched d;
    if (!Get(words, d)) return false;
    stream.switches.push_back(d);
    return true;
  }

  bool Filter(std::span<const EventWord> words) {
    Filtered d;
    if (!Get(words, d) || d.filtered > d.functions) return false;
    const auto text = Text<Filtered>(words, d.path_bytes);
    if (!text) return false;
    stream.filter.path = *text;
    stream.filter.functions += d.functions;
    stream.filter.filtered += d.filtered;
    return true;
  }

  bool Ring(std::span<const EventWord> words) {
    Overwritten d;
    // Places that were passed over make more chunks than bytes; damage would hide whole threads.
    constexpr std::uint64_t kPassedOver = 1 << 10;
    if (!Get(words, d) || d.from_ticks >= kMostTicks ||
        d.chunks > d.bytes / kGranuleBytes + kPassedOver)
      return false;
    stream.overwritten.push_back(d);
    return true;
  }

  bool Host(std::span<const EventWord>) { return stream.is_host = true; }

  bool Read(std::span<const EventWord> words) {
    switch (KindOf(words.front())) {
      case RecordKind::kDefineRegion:
        return Region(words);
      case RecordKind::kDefineLocation:
        return Location(words);
      case RecordKind::kDefineName:
        return Name(words);
      case RecordKind::kDefineChannel:
        return Channel(words);
      case RecordKind::kDefineWorld:
        return World(words);
      case RecordKind::kDefineCommunicator:
        return Communicator(words);
      case RecordKind::kDefineHost:
        return Host(words);
      case RecordKind::kClockSync:
        return Sync(words);
      case RecordKind::kLoss:
        return Lost(words);
      case RecordKind::kProcessEnd:
        return End(words);
      case RecordKind::kVisitCounts:
        return Visits(words);
      case RecordKind::kAvailability:
        return Available(words);
      case RecordKind::kCommandLine:
        return Command(words);
      case RecordKind::kDefineModule:
        return Module(words);
      case RecordKind::kDefineCode:
        return Code(words);
      case RecordKind::kSwitched:
        return Switch(words);
      case RecordKind::kFiltered:
        return Filter(words);
      case RecordKind::kOverwritten:
        return Ring(words);
      case RecordKind::kCalibration:
        return Calibrated(words);
      default:
        return true;  // of a newer writer, which says so if it matters
    }
  }
};

/// Definitions of one chunk. A zero word is a definition that was never written, or the end.
void ReadDefinitions(const Chunk& chunk, Stream& stream) {
  DefinitionReader reader{stream};
  const EventWord* last = chunk.end;
  while (last != chunk.begin && last[-1] == 0) --last;
  for (const EventWord* w = chunk.begin; w < last;) {
    const EventWord word = *w;
    if (word == 0) {  // reserved, never committed
      ++w;
      continue;
    }
    const std::uint64_t words = IsRecord(word) ? WordsOf(word) : 0;
    if (words == 0 || words > static_cast<std::uint64_t>(chunk.end - w)) {
      stream.health.Add(Defect::kBadRecord, stream.file_name);
      return;
    }
    if (!IsClosed(word)) {
      stream.health.Add(Defect::kOpenRecord, stream.file_name);
    } else if (!reader.Read({w, words})) {
      stream.health.Add(Defect::kBadDefinition, stream.file_name);
    }
    w += words;
  }
}

/// Sequence numbers are `expected` and on: what is not there was lost. Of what is there twice the
/// first counts: the second is the copy of a window whose process was killed before it lost its
/// magic. Two different chunks of one number are damage.
void OrderChunks(std::vector<Chunk>& chunks, std::uint64_t expected, Stream& stream) {
  std::ranges::stable_sort(chunks, {}, &Chunk::sequence);
  std::vector<Chunk> once;
  for (const Chunk& c : chunks) {
    if (once.empty() || once.back().sequence != c.sequence)
      once.push_back(c);
    else if (once.back().ticks != c.ticks || once.back().raw_ns != c.raw_ns)
      stream.health.Add(Defect::kBadChunk, stream.file_name);
  }
  chunks = std::move(once);
  for (const Chunk& c : chunks) {
    const std::uint64_t missing = c.sequence - expected;
    // A damaged number is one chunk out of place, not millions that are missing.
    if (missing != 0)
      stream.health.Add(Defect::kMissingChunk, stream.file_name, missing < (1 << 20) ? missing : 1);
    expected = c.sequence + 1;
  }
}

/// Chunks of a thread begin one after the other. The one that does not fit between its neighbours
/// gets the time of the one before.
void MendTimes(std::vector<Chunk>& chunks, Stream& stream) {
  for (std::size_t i = 0; i + 1 < chunks.size(); ++i) {
    if (chunks[i].ticks <= chunks[i + 1].ticks) continue;
    const std::uint64_t before =
        i == 0 ? std::min(stream.header.start_ticks, chunks[i + 1].ticks) : chunks[i - 1].ticks;
    if (chunks[i + 1].ticks >= before) {
      chunks[i].ticks = before;
    } else {
      chunks[i + 1].ticks = chunks[i].ticks;
    }
    stream.health.Add(Defect::kBadTime, stream.file_name);
  }
}

/// A page of the mapping that the file no longer has (a process that ends cuts its stream while it
/// is being read; a disk fails) becomes zeros, which are words never written.
void FillLostPage(int, siginfo_t* info, void*) {
  static const long page_bytes = sysconf(_SC_PAGESIZE);
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  void* page = reinterpret_cast<void*>(address & ~static_cast<std::uintptr_t>(page_bytes - 1));
  if (info->si_code != BUS_ADRERR ||
      mmap(page, static_cast<std::size_t>(page_bytes), PROT_READ,
           MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED)
    signal(SIGBUS, SIG_DFL);
}

/// Mappings of streams are the only ones of files that may shrink.
void SurviveLostPages() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action = {};
    action.sa_sigaction = FillLostPage;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    sigaction(SIGBUS, &action, nullptr);
  });
}

bool ReadHeader(Stream& stream, TraceHealth& health) {
  const std::span<const std::byte> file = stream.file.bytes();
  if (file.size() < sizeof(FileHeader)) {
    health.Add(Defect::kTruncatedFile, stream.file_name);
    return false;
  }
  FileHeader& h = stream.header;
  std::memcpy(&h, file.data(), sizeof(h));
  // The chunks carry their own magic, so a damaged header does not keep them from being read.
  if (h.magic != kFileMagic) stream.health.Add(Defect::kBadFileHeader, stream.file_name);
  if (h.magic == kFileMagic &&
      (h.minimum_reader_version > kFormatVersion || (h.features & ~kKnownFeatures) != 0)) {
    health.Add(Defect::kUnreadableFile, stream.file_name + " (needs a newer stipple)");
    return false;
  }
  if (h.start_ticks >= kMostTicks) {
    stream.health.Add(Defect::kBadFileHeader, stream.file_name);
    h.start_ticks = 0;
  }
  stream.boot_id = TextOf(h.boot_id, sizeof(h.boot_id));
  stream.host_name = TextOf(h.host_name, sizeof(h.host_name));
  stream.program = TextOf(h.program, sizeof(h.program));
  stream.settings = TextOf(h.settings, sizeof(h.settings));
  stream.clock_pairs.push_back({h.start_ticks, h.start_raw_ns});
  return true;
}

}  // namespace

std::optional<MappedFile> MappedFile::Open(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return std::nullopt;
  struct stat status = {};
  if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(fd);
    return std::nullopt;
  }
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* data = bytes == 0 ? nullptr : mmap(nullptr, bytes, PROT_READ, MAP_SHARED, fd, 0);
  close(fd);
  if (data == MAP_FAILED) return std::nullopt;
  SurviveLostPages();
  if (data != nullptr) madvise(data, bytes, MADV_SEQUENTIAL);
  return MappedFile(static_cast<const std::byte*>(data), bytes);
}

MappedFile::MappedFile(MappedFile&& other) noexcept : data_(other.data_), bytes_(other.bytes_) {
  other.data_ = nullptr;
  other.bytes_ = 0;
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) munmap(const_cast<std::byte*>(data_), bytes_);
}

namespace {

/// The stream with its header read; null, with the reason in `health`.
std::unique_ptr<Stream> OpenStream(const std::string& path, TraceHealth& health) {
  const std::string file_name = std::filesystem::path(path).filename();
  std::optional<MappedFile> file = MappedFile::Open(path);
  if (!file) {
    health.Add(Defect::kUnreadableFile, file_name);
    return nullptr;
  }
  auto stream = std::make_unique<Stream>(std::move(*file));
  stream->file_name = file_name;
  return ReadHeader(*stream, health) ? std::move(stream) : nullptr;
}

void ReadChunks(Stream& stream, FoundChunks found) {
  for (auto& [number, thread] : found.threads) stream.threads.push_back(std::move(thread));
  OrderChunks(found.definitions, 0, stream);
  stream.definitions = std::move(found.definitions);
  for (const Chunk& chunk : stream.definitions) ReadDefinitions(chunk, stream);
  for (ThreadStream& thread : stream.threads) {
    OrderChunks(thread.chunks, DropOverwritten(thread, stream), stream);
    OrderChunks(thread.kernel, 0, stream);
    MendSteps(thread, stream);
    MendTimes(thread.chunks, stream);
  }
  std::erase_if(stream.threads,
                [](const ThreadStream& t) { return t.chunks.empty() && t.kernel.empty(); });
  PlaceLosses(stream);
}

/// Whether the process of a stream said its end; a child of it may hold the stream still.
bool HasEnded(const std::string& path) {
  TraceHealth health;
  const std::unique_ptr<Stream> stream = OpenStream(path, health);
  if (stream == nullptr) return false;
  for (const Chunk& chunk : FindLiveDefinitions(stream->file)) ReadDefinitions(chunk, *stream);
  return stream->end.has_value();
}

/// What the process has recorded so far. What is not there yet is no defect.
std::unique_ptr<Stream> ReadLiveStream(const std::string& path, TraceHealth& health) {
  constexpr int kTries = 8;
  const std::string file_name = std::filesystem::path(path).filename();
  std::unique_ptr<Stream> stream;
  FoundChunks found;
  bool whole = false;
  for (int i = 0; i < kTries && !whole; ++i) {
    TraceHealth not_yet;
    stream = OpenStream(path, not_yet);
    if (stream == nullptr || stream->header.magic != kFileMagic) {
      health.Add(Defect::kStillRunning, file_name);
      return nullptr;
    }
    found = FindLiveChunks(*stream, path, whole);
  }
  // Events refer to definitions that were written before them: these are looked for afterwards, in
  // a file that may have grown.
  if (std::optional<MappedFile> later = MappedFile::Open(path); later) {
    stream->later.push_back(std::move(*later));
    found.definitions = FindLiveDefinitions(stream->later.back());
  }
  ReadChunks(*stream, std::move(found));
  stream->end.reset();  // it came when its last events had been looked for
  stream->running = true;
  stream->health = {};
  stream->health.Add(Defect::kStillRunning, file_name);
  return stream;
}

}  // namespace

std::unique_ptr<Stream> ReadStream(const std::string& path, TraceHealth& health) {
  if (WriterOf(path) == Writer::kThere && !HasEnded(path)) return ReadLiveStream(path, health);
  std::unique_ptr<Stream> stream = OpenStream(path, health);
  if (stream == nullptr) return nullptr;
  ReadChunks(*stream, FindChunks(*stream));
  if (!stream->end) stream->health.Add(Defect::kUnclosedProcess, stream->file_name);
  return stream;
}

std::unique_ptr<Stream> ReadIndexedStream(const std::string& path, std::string_view saved) {
  TraceHealth told_before;
  std::unique_ptr<Stream> stream = OpenStream(path, told_before);
  ByteReader from(saved);
  if (stream == nullptr || !LoadChunks(from, *stream)) return nullptr;
  for (const Chunk& chunk : stream->definitions) ReadDefinitions(chunk, *stream);
  return LoadFindings(from, *stream) ? std::move(stream) : nullptr;
}

}  // namespace stipple
