// SPDX-License-Identifier: MIT
#include "analysis/trace/chunk_code.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

namespace stipple {
namespace {

constexpr int kLevel = 3;
constexpr std::uint32_t kWideIndex = 255;  // the region itself follows, three bytes
constexpr std::size_t kRegionBytes = 3;
constexpr std::ptrdiff_t kBatch = 1024;  // operations whose columns are checked together

/// High bits of an operation; the low three are the bytes of the event's distance in time, 0: its
/// clock was not read.
enum class Operation : std::uint8_t {
  kLeaveTop,
  kEnterGuessed,
  kLeave,    // the region follows
  kEnter,    // the region follows
  kZero,     // a word never written
  kRecord,   // all its words follow, its time as distance
  kLiteral,  // the word follows
};
constexpr int kOperationShift = 3;
constexpr std::uint32_t kLengthMask = 7;
constexpr std::uint32_t kMostLength = 5;
/// Behind the columns, for a batch that is longer than they are; a distance is read as eight bytes.
constexpr std::size_t kSlack = kBatch * kLengthMask + sizeof(std::uint64_t);

/// First bytes of what zstd gets; then the table of regions, the wide words, operations, distances
/// and regions.
struct Columns {
  std::uint32_t table;       // entries of four bytes
  std::uint32_t wide;        // words
  std::uint32_t operations;  // bytes, as the two below
  std::uint32_t distances;
  std::uint32_t regions;
  std::uint32_t reserved;
};
static_assert(sizeof(Columns) == 24);

/// The time of an event record, which both sides take as a new beginning.
bool HasTicks(EventWord header) {
  return WordsOf(header) > 1 && KindOf(header) < RecordKind::kDefineRegion;
}

/// A record that enters a region, like an event.
bool IsEnter(EventWord header) {
  return KindOf(header) == RecordKind::kCountedEnter &&
         WordsOf(header) == sizeof(CountedEnter) / sizeof(EventWord);
}
std::uint32_t EnteredBy(const EventWord* record) {
  return static_cast<std::uint32_t>(record[2] & kRegionMask);
}

void Append(std::string& to, const void* data, std::size_t bytes) {
  to.append(static_cast<const char*>(data), bytes);
}

}  // namespace

CallModel CallMemory::Begin(std::size_t words) {
  if (open_.size() < words + 2) open_.resize(words + 2);
  open_[0] = open_[1] = 0;
  guesses_.assign(CallModel::kPlaces, 0);
  return {open_.data() + 1, guesses_.data()};
}

struct ChunkCoder::State {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  CallMemory memory;
  CallModel model = memory.Begin(0);
  std::uint64_t now = 0;
  std::uint64_t events = 0;
  std::string operations;
  std::string distances;
  std::vector<std::uint32_t> regions;  // of the operations that name one
  std::vector<EventWord> wide;

  State() { ZSTD_CCtx_setParameter(zstd, ZSTD_c_checksumFlag, 1); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { ZSTD_freeCCtx(zstd); }

  void Begin(std::size_t words) {
    model = memory.Begin(words);
    now = events = 0;
    operations.clear();
    distances.clear();
    regions.clear();
    wide.clear();
  }

  void Operate(Operation operation, std::uint32_t length = 0) {
    operations.push_back(
        static_cast<char>((static_cast<std::uint32_t>(operation) << kOperationShift) | length));
  }

  /// Bytes of the distance.
  std::uint32_t Distance(EventWord word) {
    if (TimeOf(word) == 0) return 0;
    const std::uint64_t distance = (TimeOf(word) - now) & kTimeMask;
    now += distance;
    std::uint32_t length = 1;
    while (length < kMostLength && (distance >> (8 * length)) != 0) ++length;
    Append(distances, &distance, length);
    return length;
  }

  void Event(EventWord word) {
    const std::uint32_t length = Distance(word);
    const auto region = static_cast<std::uint32_t>(RegionOf(word));
    bool known = false;
    if (IsLeave(word)) {
      known = model.depth() != 0 && model.top() == region;
      Operate(known ? Operation::kLeaveTop : Operation::kLeave, length);
      model.Leave(region);
    } else {
      std::uint32_t& guess = model.Guess();
      known = guess == region;
      guess = region;
      Operate(known ? Operation::kEnterGuessed : Operation::kEnter, length);
      model.Enter(region);
    }
    if (!known) regions.push_back(region);
    ++events;
  }

  /// The words that were coded.
  std::uint64_t Record(const EventWord* word, std::uint64_t room) {
    const std::uint64_t words = WordsOf(*word);
    if (words == 0 || words > room) {
      Operate(Operation::kLiteral);
      wide.push_back(*word);
      return 1;
    }
    Operate(Operation::kRecord);
    wide.insert(wide.end(), word, word + words);
    if (HasTicks(*word)) {
      wide[wide.size() - words + 1] -= now;
      now = word[1];
    }
    if (IsEnter(*word)) model.Enter(EnteredBy(word));
    events += IsClosed(*word) ? 1 : 0;
    return words;
  }

  /// The most frequent regions that are named, which one byte can name.
  std::vector<std::uint32_t> Table() const {
    std::map<std::uint32_t, std::uint32_t> counts;
    for (const std::uint32_t region : regions) ++counts[region];
    std::vector<std::uint32_t> table;
    for (const auto& [region, count] : counts) table.push_back(region);
    std::ranges::stable_sort(
        table, [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
    if (table.size() > kWideIndex) table.resize(kWideIndex);
    return table;
  }

  std::string Content() const {
    const std::vector<std::uint32_t> table = Table();
    std::map<std::uint32_t, std::uint32_t> indices;
    for (std::uint32_t i = 0; i < table.size(); ++i) indices.emplace(table[i], i);
    std::string named;
    for (const std::uint32_t region : regions) {
      const auto found = indices.find(region);
      named.push_back(static_cast<char>(found == indices.end() ? kWideIndex : found->second));
      if (found == indices.end()) Append(named, &region, kRegionBytes);
    }
    const Columns columns{
        static_cast<std::uint32_t>(table.size()),      static_cast<std::uint32_t>(wide.size()),
        static_cast<std::uint32_t>(operations.size()), static_cast<std::uint32_t>(distances.size()),
        static_cast<std::uint32_t>(named.size()),      0};
    std::string content;
    Append(content, &columns, sizeof(columns));
    Append(content, table.data(), table.size() * sizeof(table[0]));
    Append(content, wide.data(), wide.size() * sizeof(EventWord));
    return content + operations + distances + named;
  }
};

ChunkCoder::ChunkCoder() : state_(std::make_unique<State>()) {}
ChunkCoder::~ChunkCoder() = default;

CodedChunk ChunkCoder::Code(std::span<const EventWord> words) {
  State& s = *state_;
  CodedChunk coded;
  if (words.size() > kMostCompactedWords) return coded;
  s.Begin(words.size());
  std::size_t written = words.size();
  while (written != 0 && words[written - 1] == 0) --written;
  for (std::size_t i = 0; i < written;) {
    const EventWord word = words[i];
    if (word == 0)
      s.Operate(Operation::kZero);
    else if (!IsRecord(word))
      s.Event(word);
    i += word != 0 && IsRecord(word) ? s.Record(&words[i], words.size() - i) : 1;
  }
  const std::string content = s.Content();
  coded.frame.resize(ZSTD_compressBound(content.size()));
  ZSTD_CCtx_setParameter(s.zstd, ZSTD_c_compressionLevel, kLevel);
  const std::size_t bytes = ZSTD_compress2(s.zstd, coded.frame.data(), coded.frame.size(),
                                           content.data(), content.size());
  coded.frame.resize(ZSTD_isError(bytes) != 0 ? 0 : bytes);
  coded.events = s.events;
  return coded;
}

namespace {

/// What the operation of an event says, as masks.
struct EventOperation {
  std::uint64_t distance;  // of eight bytes, those that are
  std::uint64_t time;      // 0: no clock
  std::uint32_t leaves;
  std::uint32_t names;
  std::uint32_t length;
};
constexpr auto kEventOperations = [] {
  std::array<EventOperation, static_cast<std::size_t>(Operation::kZero) << kOperationShift> all{};
  for (std::uint32_t byte = 0; byte < all.size(); ++byte) {
    const auto operation = static_cast<Operation>(byte >> kOperationShift);
    const std::uint32_t length = byte & kLengthMask;
    const bool leave = operation == Operation::kLeaveTop || operation == Operation::kLeave;
    all[byte] = {length > kMostLength ? 0 : (std::uint64_t{1} << (8 * length)) - 1,
                 length == 0 ? 0 : ~std::uint64_t{0}, leave ? ~std::uint32_t{0} : 0,
                 operation >= Operation::kLeave ? ~std::uint32_t{0} : 0, length};
  }
  return all;
}();

}  // namespace

struct ChunkDecoder::State {
  ZSTD_DCtx* zstd = ZSTD_createDCtx();
  CallMemory memory;
  std::vector<char> content;
  // Regions that one byte names; those that it does not are kKindBase.
  std::array<std::uint32_t, kWideIndex + 1> table;
  // What is left of each column.
  const char* operations = nullptr;
  const char* operations_end = nullptr;
  const char* distances = nullptr;
  const char* distances_end = nullptr;
  const char* regions = nullptr;
  const char* regions_end = nullptr;
  const char* wide = nullptr;
  const char* wide_end = nullptr;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { ZSTD_freeDCtx(zstd); }

  /// Takes the frame apart; false: it is damaged, or holds more than the words can need.
  bool Open(std::span<const std::byte> frame, std::size_t words) {
    const std::size_t most = sizeof(Columns) + kWideIndex * sizeof(std::uint32_t) +
                             words * (1 + kMostLength + 1 + kRegionBytes + sizeof(EventWord));
    const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
    if (size > most || size < sizeof(Columns)) return false;  // errors are the largest numbers
    if (content.size() < size + kSlack) content.resize(size + kSlack);
    const std::size_t bytes =
        ZSTD_decompressDCtx(zstd, content.data(), size, frame.data(), frame.size());
    if (ZSTD_isError(bytes) != 0 || bytes != size) return false;
    Columns c;
    std::memcpy(&c, content.data(), sizeof(c));
    const std::uint64_t all = sizeof(c) + std::uint64_t{c.table} * sizeof(std::uint32_t) +
                              std::uint64_t{c.wide} * sizeof(EventWord) +
                              std::uint64_t{c.operations} + std::uint64_t{c.distances} +
                              std::uint64_t{c.regions};
    if (all != size || c.table > kWideIndex) return false;
    table.fill(kKindBase);
    const char* at = content.data() + sizeof(c);
    if (c.table != 0) std::memcpy(table.data(), at, c.table * sizeof(std::uint32_t));
    wide = at + c.table * sizeof(std::uint32_t);
    operations = wide_end = wide + c.wide * sizeof(EventWord);
    distances = operations_end = operations + c.operations;
    regions = distances_end = distances + c.distances;
    regions_end = regions + c.regions;
    return true;
  }

  /// False: there is none.
  bool Region(std::uint32_t& region) {
    if (regions >= regions_end) return false;
    const auto index = static_cast<unsigned char>(*regions++);
    region = table[index];
    if (index == kWideIndex) {
      if (regions_end - regions < static_cast<std::ptrdiff_t>(kRegionBytes)) return false;
      region = 0;
      std::memcpy(&region, regions, kRegionBytes);
      regions += kRegionBytes;
    }
    return region < kKindBase;
  }

  /// An operation without an event; the words it made, 0: damaged.
  std::uint64_t Other(Operation operation, EventWord* to, std::uint64_t room, std::uint64_t now) {
    *to = 0;
    if (operation == Operation::kZero) return 1;
    if (operation > Operation::kLiteral || wide == wide_end) return 0;
    std::memcpy(to, wide, sizeof(EventWord));
    const std::uint64_t words = operation == Operation::kLiteral ? 1 : WordsOf(*to);
    if (words > room || words > static_cast<std::uint64_t>(wide_end - wide) / sizeof(EventWord))
      return 0;
    std::memcpy(to, wide, words * sizeof(EventWord));
    wide += words * sizeof(EventWord);
    if (operation == Operation::kLiteral) return 1;
    if (HasTicks(*to)) to[1] += now;
    return words;
  }
};

ChunkDecoder::ChunkDecoder() : state_(std::make_unique<State>()) {}
ChunkDecoder::ChunkDecoder(ChunkDecoder&&) noexcept = default;
ChunkDecoder& ChunkDecoder::operator=(ChunkDecoder&&) noexcept = default;
ChunkDecoder::~ChunkDecoder() = default;

bool ChunkDecoder::Decode(std::span<const std::byte> frame, std::span<EventWord> words) {
  State& s = *state_;
  if (words.size() > kMostCompactedWords || !s.Open(frame, words.size())) return false;
  std::uint64_t now = 0;
  EventWord* to = words.data();
  EventWord* const end = to + words.size();
  CallModel model = s.memory.Begin(words.size());
  const char* distance = s.distances;
  const char* regions = s.regions;
  const char* at = s.operations;
  while (at != s.operations_end) {
    const char* const stop = at + std::min({s.operations_end - at, end - to, kBatch});
    if (at == stop) return false;
    for (; at != stop; ++at) {
      const auto byte = static_cast<unsigned char>(*at);
      if (byte >= kEventOperations.size()) [[unlikely]]
        break;
      const EventOperation& operation = kEventOperations[byte];
      std::uint64_t more = 0;
      std::memcpy(&more, distance, sizeof(more));
      distance += operation.length;
      now += more & operation.distance;
      std::uint32_t region = 0;
      // With the slack there is a byte, even behind the last region.
      const std::uint32_t named = s.table[static_cast<unsigned char>(*regions)] & operation.names;
      const bool is_odd = (named >= kKindBase) | ((operation.leaves & operation.names) != 0) |
                          ((operation.leaves != 0) & (model.depth() == 0));
      if (is_odd) [[unlikely]] {
        s.regions = regions;
        if (operation.names == 0 || !s.Region(region)) return false;
        regions = s.regions;
        if (operation.leaves != 0) {
          model.Leave(region);
        } else {
          model.Guess() = region;
          model.Enter(region);
        }
      } else {
        regions += operation.names & 1;
        region = model.Step(operation.leaves, operation.names, named);
      }
      *to++ = (now & operation.time) << kTimeShift | (operation.leaves & kLeaveBit) | region;
    }
    if (distance > s.distances_end || regions > s.regions_end) return false;
    if (at == stop) continue;
    const auto operation =
        static_cast<Operation>(static_cast<unsigned char>(*at++) >> kOperationShift);
    const std::uint64_t made = s.Other(operation, to, static_cast<std::uint64_t>(end - to), now);
    if (made == 0) return false;
    if (operation == Operation::kRecord && HasTicks(*to)) now = to[1];
    if (operation == Operation::kRecord && IsEnter(*to)) model.Enter(EnteredBy(to));
    to += made;
  }
  std::fill(to, end, 0);
  return true;
}

}  // namespace stipple
