// SPDX-License-Identifier: MIT
// Of the format: the file, its chunks, and the words in them.
#ifndef STIPPLE_FORMAT_WORDS_H
#define STIPPLE_FORMAT_WORDS_H

#include <cstddef>
#include <cstdint>

namespace stipple {

inline constexpr std::uint64_t kFileMagic = 0x31656c7070697473;   // "stipple1"
inline constexpr std::uint64_t kChunkMagic = 0x6b6e756863707473;  // "stpchunk"
inline constexpr std::uint32_t kFormatVersion = 1;
inline constexpr std::uint32_t kGranuleBytes = 16 * 1024;

/// Features that a reader must know to read a stream at all; a set bit it does not know makes it
/// refuse.
enum class Feature : std::uint64_t {
  kCompacted = 1,  // chunks stand behind each other, those of events are coded: `stipple compact`
  kStackSwitches = 2,  // set when the first StackSwitch is written
};

/// What `ticks` count.
enum class ClockKind : std::uint32_t {
  kTsc = 1,      // time-stamp counter; ticks per second follow from the chunk headers' pairs
  kVirtual = 2,  // simulated nanoseconds
};

/// First bytes of a stream file. The first chunk follows at kGranuleBytes.
struct FileHeader {
  std::uint64_t magic;  // written last
  std::uint32_t version;
  std::uint32_t minimum_reader_version;
  std::uint64_t features;  // Feature bits
  std::uint32_t pid;
  std::uint32_t parent_pid;
  std::uint64_t start_realtime_ns;  // CLOCK_REALTIME when the stream began
  std::uint64_t start_raw_ns;       // CLOCK_MONOTONIC_RAW at start_ticks
  std::uint64_t start_ticks;
  ClockKind clock;
  std::uint32_t forked;  // 1: begun by a child of fork, in the parent's program
  std::uint64_t tsc_hz;  // as the processor states it; 0: unknown
  char boot_id[40];  // text of /proc/sys/kernel/random/boot_id: processes with the same one share
                     // the TSC
  char host_name[64];
  char program[256];   // file name of the executable
  char settings[256];  // clock mode and other settings as text, "clock=exact"
};
static_assert(sizeof(FileHeader) == 688);

enum class ChunkKind : std::uint32_t {
  kEvents = 1,       // of one thread, in the order of the slots
  kDefinitions = 2,  // of the process: definitions, clock readings, losses, the end; never recycled
  kKernel = 4,  // of one thread, what the kernel tells of it: ContextSwitch, Counter; their times
                // are nanoseconds of CLOCK_MONOTONIC_RAW
  kCompacted = 3,  // kEvents, coded; only in a stream with Feature::kCompacted
};

/// First bytes of a chunk.
struct ChunkHeader {
  std::uint64_t magic;  // written last
  std::uint32_t bytes;  // of the whole chunk, header included
  ChunkKind kind;
  std::uint32_t thread;    // index within the process; 0 is the thread that began the stream
  std::uint32_t tid;       // the kernel's
  std::uint64_t sequence;  // 0, 1, ... within the thread's chunks of this kind
  std::uint64_t ticks;     // full 64-bit time when the chunk was taken
  std::uint64_t raw_ns;    // CLOCK_MONOTONIC_RAW at `ticks`
  std::uint64_t lost;      // events this thread had lost before this chunk, in all
  std::uint64_t reserved;
};
static_assert(sizeof(ChunkHeader) == 64);

// A stream with Feature::kCompacted has no granules: its first chunk stands at
// kFirstCompactedByte, each further one behind the one before, all multiples of kCompactedAlign.
inline constexpr std::uint32_t kCompactedAlign = 64;
inline constexpr std::uint32_t kFirstCompactedByte = 704;
static_assert(kFirstCompactedByte >= sizeof(FileHeader) &&
              kFirstCompactedByte % kCompactedAlign == 0);

/// Behind the header of a chunk of kind kCompacted; `coded_bytes` of a zstd frame follow.
struct CompactedChunk {
  std::uint64_t words;        // of the chunk as it was, behind its header
  std::uint64_t coded_bytes;  // of the frame
};
static_assert(sizeof(CompactedChunk) == 16);
inline constexpr std::uint64_t kMostCompactedWords = std::uint64_t{1} << 21;

/// One word of a chunk.
using EventWord = std::uint64_t;

/// A region within one process, 1 .. kMaxRegion.
enum class RegionId : std::uint32_t {};

inline constexpr std::uint64_t kRegionMask = 0x7fffff;
inline constexpr std::uint64_t kLeaveBit = 0x800000;
inline constexpr int kTimeShift = 24;
inline constexpr std::uint64_t kTimeMask = (std::uint64_t{1} << 40) - 1;  // of ticks
inline constexpr std::uint32_t kMaxRegion = 0x7ffeff;
inline constexpr std::uint32_t kKindBase =
    0x7fff00;  // low 23 bits from here on: an extended record, kind = value - base

/// A function event. Time is the low 40 bits of ticks; 0 means that the clock was not read: between
/// its neighbours.
constexpr EventWord MakeEvent(std::uint64_t ticks, bool leave, RegionId region) {
  return (ticks << kTimeShift) | (leave ? kLeaveBit : 0) | static_cast<std::uint64_t>(region);
}
constexpr RegionId RegionOf(EventWord word) {
  return RegionId{static_cast<std::uint32_t>(word & kRegionMask)};
}
constexpr bool IsLeave(EventWord word) { return (word & kLeaveBit) != 0; }
constexpr std::uint64_t TimeOf(EventWord word) { return word >> kTimeShift; }

/// Kinds of extended records. Definitions stand in definition chunks, the others in event chunks.
enum class RecordKind : std::uint8_t {
  // Events.
  kMark = 1,
  kCounter = 2,
  kMpiSend = 3,
  kMpiReceivePost = 4,
  kMpiReceive = 5,
  kMpiRequestEnd = 6,
  kMpiCollective = 7,
  kMpiProbe = 8,
  kTransmission = 9,  // simulation: physical start and end
  kUnwound = 10,      // frames left by a jump
  kRegionMode = 11,   // the budget changed a region's mode
  kContextSwitch = 12,
  kSystemCall = 13,
  kSample = 14,
  kOpenFrames = 15,  // call stack when a ring overwrote what came before
  kTimeStamp = 16,   // a thread that was silent for long
  kThreadEnd = 17,
  kClockStep = 18,
  kJumpPoint = 19,     // setjmp, getcontext
  kStackSwitch = 20,   // swapcontext, setcontext, the end of a context
  kCountedEnter = 21,  // a timed visit of a region whose other visits are counted or have no time
  kThreadSend = 22,    // user.h: a message to another thread
  kThreadReceive = 23,
  kCallPath = 24,  // frames below the events: code without instrumentation
  kCrash = 25,     // a signal ends the process: a thread's stack
  // Definitions.
  kDefineRegion = 64,
  kDefineLocation = 65,
  kDefineName = 66,
  kDefineWorld = 67,
  kDefineCommunicator = 68,
  kDefineHost = 69,
  kClockSync = 70,
  kLoss = 71,
  kProcessEnd = 72,
  kVisitCounts = 73,
  kAvailability = 74,
  kCommandLine = 75,
  kDefineModule = 76,
  kDefineCode = 77,
  kSwitched = 78,
  kFiltered = 79,
  kCalibration = 80,    // what an event costs, and how much of that lies inside the visit
  kOverwritten = 81,    // a ring dropped what came before
  kDefineChannel = 82,  // user.h: what messages between threads go through
};

// The header of an extended record: kind in the low 23 bits, bit 23 set once the record is closed,
// length in 8-byte words (header included) in bits 24-47. An open header is a record that its
// writer did not finish.
inline constexpr std::uint64_t kClosedBit = std::uint64_t{1} << 23;
inline constexpr std::uint32_t kMaxRecordWords = 0xffffff;
constexpr EventWord MakeHeader(RecordKind kind, std::uint64_t words, bool closed) {
  return (words << 24) | (closed ? kClosedBit : 0) | (kKindBase + static_cast<std::uint64_t>(kind));
}
constexpr bool IsRecord(EventWord word) { return (word & kRegionMask) >= kKindBase; }
constexpr bool IsClosed(EventWord word) { return (word & kClosedBit) != 0; }
constexpr RecordKind KindOf(EventWord word) {
  return static_cast<RecordKind>((word & kRegionMask) - kKindBase);
}
constexpr std::uint64_t WordsOf(EventWord word) { return (word >> 24) & kMaxRecordWords; }

/// What a region is; decides its colour and its part in the states.
enum class RegionKind : std::uint32_t { kFunction = 1, kMpi = 2, kUser = 3, kSystem = 4 };

}  // namespace stipple

#endif
