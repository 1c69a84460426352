// SPDX-License-Identifier: MIT
// What lands on disk, version 1. Written by runtime/, read by analysis/trace; docs/format.md says
// the same in prose.
//
// An archive is a directory NAME.stipple with one stream file HOSTNAME.PID.START.stream per
// process. A stream file is a FileHeader, then chunks, each a multiple of kGranuleBytes and aligned
// to it; bytes never written are zero. A chunk is a ChunkHeader, then words. A word that is zero
// was never committed. Any other word is either a function event (8 bytes) or the header of an
// extended record, told apart by the low 23 bits. Little-endian throughout. Values once used are
// never reused; zero means "not written yet".
#ifndef STIPPLE_FORMAT_H
#define STIPPLE_FORMAT_H

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

// Every record below begins with `header`; each event with `ticks`, this location's clock, all 64
// bits.

/// The program marked a moment (user.h).
struct Mark {
  static constexpr RecordKind kKind = RecordKind::kMark;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t name;  // DefineName
  std::uint32_t reserved;
};
static_assert(sizeof(Mark) == 24);

/// A counter has this value from now on (user.h).
struct Counter {
  static constexpr RecordKind kKind = RecordKind::kCounter;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t name;  // DefineName
  std::uint32_t reserved;
  double value;
};
static_assert(sizeof(Counter) == 32);

// Messages between threads of one process (user.h). On one channel with one key the first that was
// sent is the first that is received.

/// This thread is about to hand a message to another one.
struct ThreadSend {
  static constexpr RecordKind kKind = RecordKind::kThreadSend;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t bytes;
  std::uint64_t key;      // the program's own
  std::uint32_t channel;  // DefineChannel
  std::uint32_t reserved;
};
static_assert(sizeof(ThreadSend) == 40);

/// This thread has taken a message.
struct ThreadReceive {
  static constexpr RecordKind kKind = RecordKind::kThreadReceive;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t bytes;
  std::uint64_t key;
  std::uint64_t waiting_since;  // ticks when the thread began to look for it; 0: not told
  std::uint32_t channel;        // DefineChannel
  std::uint32_t reserved;
};
static_assert(sizeof(ThreadReceive) == 48);

/// A message was handed to MPI on this location, before the call went on. None for MPI_PROC_NULL.
struct MpiSend {
  static constexpr RecordKind kKind = RecordKind::kMpiSend;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t bytes;
  std::uint32_t communicator;  // DefineCommunicator
  std::int32_t receiver;       // rank in `communicator`
  std::int32_t tag;
  std::uint32_t request;  // number of the request within the process; 0: blocking
};
static_assert(sizeof(MpiSend) == 40);

/// A non-blocking receive was posted (or started again, or matched by a probe); it matches in this
/// order.
struct MpiReceivePost {
  static constexpr RecordKind kKind = RecordKind::kMpiReceivePost;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t communicator;
  std::uint32_t request;  // never 0
};
static_assert(sizeof(MpiReceivePost) == 24);

/// A receive is complete; sender and tag are the message's own, never wildcards. A blocking receive
/// (request 0) was posted where its call was entered.
struct MpiReceive {
  static constexpr RecordKind kKind = RecordKind::kMpiReceive;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t bytes;
  std::uint32_t communicator;
  std::int32_t sender;  // rank in `communicator`
  std::int32_t tag;
  std::uint32_t request;  // that of the post; 0: blocking
};
static_assert(sizeof(MpiReceive) == 40);

/// A request ended without a message of its own: a send completed, a request was cancelled or
/// freed.
struct MpiRequestEnd {
  static constexpr RecordKind kKind = RecordKind::kMpiRequestEnd;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t request;
  std::uint32_t outcome;  // 1 completed, 2 cancelled, 3 freed while active
};
static_assert(sizeof(MpiRequestEnd) == 24);

/// This location entered a collective; the n-th on a communicator is the same one on all its ranks.
struct MpiCollective {
  static constexpr RecordKind kKind = RecordKind::kMpiCollective;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t bytes_sent;      // by this rank, itself included
  std::uint64_t bytes_received;  // by this rank
  std::uint32_t communicator;
  std::int32_t root;      // rank in `communicator`; -1: none
  std::uint32_t region;   // of the call
  std::uint32_t request;  // 0: blocking
};
static_assert(sizeof(MpiCollective) == 48);

/// A probe found a message waiting.
struct MpiProbe {
  static constexpr RecordKind kKind = RecordKind::kMpiProbe;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t bytes;
  std::uint32_t communicator;
  std::int32_t sender;
  std::int32_t tag;
  std::uint32_t reserved;
};
static_assert(sizeof(MpiProbe) == 40);

/// The thread ended; frames open now were left.
struct ThreadEnd {
  static constexpr RecordKind kKind = RecordKind::kThreadEnd;
  EventWord header;
  std::uint64_t ticks;
};
static_assert(sizeof(ThreadEnd) == 16);

/// The full time of a thread that was silent for long.
struct TimeStamp {
  static constexpr RecordKind kKind = RecordKind::kTimeStamp;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t raw_ns;
};
static_assert(sizeof(TimeStamp) == 24);

/// The thread's clock was set back, or ran at another rate for a while: between the begins of two
/// chunks of the thread. `ticks` is below `before_ticks`, or their difference does not fit that of
/// CLOCK_MONOTONIC_RAW.
struct ClockStep {
  static constexpr RecordKind kKind = RecordKind::kClockStep;
  EventWord header;
  std::uint64_t ticks;  // of this chunk's begin
  std::uint64_t raw_ns;
  std::uint64_t before_ticks;  // of the begin of the thread's chunk before
  std::uint64_t before_raw_ns;
};
static_assert(sizeof(ClockStep) == 40);

/// A visit that was open when a chunk of a ring began.
struct OpenFrame {
  std::uint64_t ticks;  // when it was entered; 0: the clock was not read
  std::uint32_t region;
  std::uint32_t reserved;
};
static_assert(sizeof(OpenFrame) == 16);

/// A jump point that was alive then.
struct OpenPoint {
  std::uint64_t stack;  // JumpPoint
  std::uint64_t depth;  // frames that were open there
};
static_assert(sizeof(OpenPoint) == 16);

/// Where a thread stood when this chunk of a ring (--max-bytes) began: first record of each chunk
/// but the thread's first. `frames` OpenFrames follow, outermost first, then `points` OpenPoints.
struct OpenFrames {
  static constexpr RecordKind kKind = RecordKind::kOpenFrames;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t depth;  // frames that were open; if more than `frames`, the innermost ones follow
  std::uint32_t frames;
  std::uint32_t points;
  std::uint32_t unknown;  // 1: the thread has switched stacks, its frames are not known
};
static_assert(sizeof(OpenFrames) == 32);

// Jumps. A thread's jump points are told apart by the stack pointer that they go back to: of two
// with the same one only the later is alive.

/// The program may come back to here, and to the frames that are open now, by a jump.
struct JumpPoint {
  static constexpr RecordKind kKind = RecordKind::kJumpPoint;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t stack;
};
static_assert(sizeof(JumpPoint) == 24);

/// The program jumps to the last jump point with this `stack`: frames opened since are left. A
/// point that the stream does not have was set before its thread's first event: all frames are
/// left.
struct Unwound {
  static constexpr RecordKind kKind = RecordKind::kUnwound;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t stack;  // 0: the thread's function is left
};
static_assert(sizeof(Unwound) == 24);

/// The thread goes on with the jump point `to` on another stack; what is open now waits at the jump
/// point `from`. A `to` that the stream does not have is a new context, without open frames.
struct StackSwitch {
  static constexpr RecordKind kKind = RecordKind::kStackSwitch;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t from;
  std::uint64_t to;
};
static_assert(sizeof(StackSwitch) == 32);

/// How much of a region's visits is recorded, from now on in all threads of the process. The budget
/// (--clock budget:P) takes one step at a time.
enum class RegionModeKind : std::uint32_t {
  kTimed = 0,    // each enter and leave has its time
  kNoClock = 1,  // each enter and leave is an event without a time
  kCounted = 2,  // visits are counted, events are written for a stride of them
};

/// The budget changed how visits of a region are recorded. Visits that are open end as they began.
struct RegionMode {
  static constexpr RecordKind kKind = RecordKind::kRegionMode;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t region;
  RegionModeKind mode;
  std::uint64_t visits;      // by this process until now, as far as the budget has seen them
  std::uint64_t mean_ticks;  // of the visits that the decision rests on, enter to leave; 0: unknown
};
static_assert(sizeof(RegionMode) == 40);

enum class CountedPurpose : std::uint32_t {
  kSample = 1,  // one visit of a stride; stands for those before it, back to the last sample
  kInside = 2,  // directly inside a sample, whose exclusive time would not be known without it
};

/// Enters a region whose mode is not kTimed, with a time, read with the pipeline drained. Its leave
/// is an event like any other. Samples are 1024 to 1151 visits apart, by chance. Of one that a jump
/// or a change of stacks interrupts, what is inside may be missing.
struct CountedEnter {
  static constexpr RecordKind kKind = RecordKind::kCountedEnter;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t region;
  CountedPurpose purpose;
  // Of the region by this thread, without any event, since its last sample. 0 for kInside. All of
  // these, the entries of VisitCounts and the enters are the region's visits.
  std::uint64_t visits;
};
static_assert(sizeof(CountedEnter) == 32);

enum class SwitchReason : std::uint32_t {
  kBlocked = 1,    // it waited for something
  kPreempted = 2,  // it could have gone on: another was given the processor, or it yielded
};

/// The thread was off its processor. Only in chunks of kind kKernel, in the order of `in_ns`. A run
/// of short absences (each under 10 us, preempted) is one record.
struct ContextSwitch {
  static constexpr RecordKind kKind = RecordKind::kContextSwitch;
  EventWord header;
  std::uint64_t out_ns;   // CLOCK_MONOTONIC_RAW: it left its processor
  std::uint64_t in_ns;    // it was back; 0: it was not when the process ended
  std::uint64_t away_ns;  // in_ns - out_ns, for a run only the absences
  std::uint32_t out_cpu;
  std::uint32_t in_cpu;  // another one: it migrated
  SwitchReason reason;
  std::uint32_t count;     // absences in this record
  std::uint32_t next_tid;  // the thread that took the processor over; 0: not known
  std::uint32_t reserved;
};
static_assert(sizeof(ContextSwitch) == 56);

/// A system call has returned, `ticks`: when. Up to six words of parameters follow, as many as the
/// record's length says. A call that was left by a jump or by the thread's cancellation has none.
struct SystemCall {
  static constexpr RecordKind kKind = RecordKind::kSystemCall;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t enter_ticks;
  std::int64_t result;   // as the kernel gives it: an error is -errno
  std::uint32_t number;  // of the kernel, x86-64
  std::uint32_t
      name;  // DefineName of the libc function if that is called otherwise (sleep); else 0
};
static_assert(sizeof(SystemCall) == 40);

// Native stacks: `frames` words follow the struct, innermost first. A word is the number of a
// module (DefineModule) in the high 16 bits and an offset as in DefineCode in the others; module 0:
// an address outside of any file. But for the first word of a sample or of a crash they are return
// addresses: the call is just before.

inline constexpr int kFrameModuleShift = 48;
inline constexpr std::uint64_t kFrameOffsetMask = (std::uint64_t{1} << kFrameModuleShift) - 1;
inline constexpr std::uint32_t kMostFrames = 256;      // of one stack
inline constexpr std::uint32_t kMostOuterFrames = 64;  // of them, the outermost of a cut stack

/// For `cut`: more than kMostFrames, and of those only the innermost are there.
inline constexpr std::uint32_t kUnknownCut = 0xffffffff;

/// The thread was found running here.
struct Sample {
  static constexpr RecordKind kKind = RecordKind::kSample;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t cpu_ns;  // processor time of the thread that the sample stands for
  std::uint32_t frames;
  std::uint32_t cut;  // frames left out, before the last kMostOuterFrames; 0: none
};
static_assert(sizeof(Sample) == 32);

/// Frames below the event before it, a message, a mark or a collective; without frames of stipple.
struct CallPath {
  static constexpr RecordKind kKind = RecordKind::kCallPath;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t frames;
  std::uint32_t cut;  // as in Sample
};
static_assert(sizeof(CallPath) == 24);

/// A signal ends the process; where this thread was. One for each thread that answered.
struct Crash {
  static constexpr RecordKind kKind = RecordKind::kCrash;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t address;  // si_addr; with code <= 0 (sent by a process): the sender's pid
  std::int32_t signal;    // 0: another thread's
  std::int32_t code;      // si_code
  std::uint32_t frames;
  std::uint32_t cut;  // as in Sample
};
static_assert(sizeof(Crash) == 40);

// Definitions. Text follows the struct: its parts without terminators, one after the other,
// zero-padded to 8 bytes.

struct DefineRegion {
  static constexpr RecordKind kKind = RecordKind::kDefineRegion;
  EventWord header;
  std::uint32_t region;
  RegionKind region_kind;
  std::uint32_t line;        // 0: unknown
  std::uint32_t name_bytes;  // linkage name
  std::uint32_t file_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineRegion) == 32);

struct DefineLocation {
  static constexpr RecordKind kKind = RecordKind::kDefineLocation;
  EventWord header;
  std::uint32_t thread;
  std::uint32_t tid;
  std::uint32_t name_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineLocation) == 24);

/// Name and unit of a mark or counter.
struct DefineName {
  static constexpr RecordKind kKind = RecordKind::kDefineName;
  EventWord header;
  std::uint32_t name;
  std::uint32_t name_bytes;
  std::uint32_t unit_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineName) == 24);

/// What messages between threads go through.
struct DefineChannel {
  static constexpr RecordKind kKind = RecordKind::kDefineChannel;
  EventWord header;
  std::uint32_t channel;
  std::uint32_t name_bytes;
};
static_assert(sizeof(DefineChannel) == 16);

/// This process is a rank of an MPI program.
struct DefineWorld {
  static constexpr RecordKind kKind = RecordKind::kDefineWorld;
  EventWord header;
  std::int32_t world_rank;
  std::int32_t world_size;
};
static_assert(sizeof(DefineWorld) == 16);

/// A communicator, numbered within the process; 1 is MPI_COMM_WORLD, 2 is MPI_COMM_SELF. The same
/// communicator on two ranks has the same parent, creation number and first member. `size` world
/// ranks follow, as int32, in rank order.
struct DefineCommunicator {
  static constexpr RecordKind kKind = RecordKind::kDefineCommunicator;
  EventWord header;
  std::uint32_t communicator;
  std::uint32_t parent;    // 0: none
  std::uint32_t creation;  // how many communicators this rank had created from the parent before
  std::int32_t size;
};
static_assert(sizeof(DefineCommunicator) == 24);

/// This process hands out work (user.h).
struct DefineHost {
  static constexpr RecordKind kKind = RecordKind::kDefineHost;
  EventWord header;
};
static_assert(sizeof(DefineHost) == 8);

/// One reading of another process's clock: `local_ticks` here and `remote_ticks` there happened
/// together, to within half of round_trip_ticks.
struct ClockSync {
  static constexpr RecordKind kKind = RecordKind::kClockSync;
  EventWord header;
  std::uint64_t local_ticks;
  std::uint64_t remote_ticks;
  std::uint64_t round_trip_ticks;  // least of all tries, local clock
  std::int32_t remote_world_rank;
  std::uint32_t tries;
};
static_assert(sizeof(ClockSync) == 40);

/// Events that could not be recorded.
struct Loss {
  static constexpr RecordKind kKind = RecordKind::kLoss;
  EventWord header;
  std::uint64_t from_ticks;
  std::uint64_t events;  // of this process, in all, when the record was written
  std::int32_t error;    // errno that began it; 0: none
  std::uint32_t reserved;
};
static_assert(sizeof(Loss) == 32);

/// The runtime saw the process's end: return from main, exit, _exit, abort or a fatal signal.
struct ProcessEnd {
  static constexpr RecordKind kKind = RecordKind::kProcessEnd;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t raw_ns;  // CLOCK_MONOTONIC_RAW at `ticks`
  std::uint64_t lost;    // events of the process that could not be recorded
  std::uint32_t how;     // 1 return or exit, 2 _exit, 3 abort, 4 exec, 5 signal (status: which)
  std::int32_t status;
};
static_assert(sizeof(ProcessEnd) == 40);

/// Visits without any event since the thread's last sample of the region (CountedEnter); `entries`
/// of (u32 region, u32 thread, u64 visits) follow.
struct VisitCounts {
  static constexpr RecordKind kKind = RecordKind::kVisitCounts;
  EventWord header;
  std::uint64_t entries;
};
static_assert(sizeof(VisitCounts) == 16);

/// What this process records, and what it could not: `what` as text, "switches", "system calls".
struct Availability {
  static constexpr RecordKind kKind = RecordKind::kAvailability;
  EventWord header;
  std::uint32_t available;  // 0 no, 1 yes
  std::int32_t error;       // errno of the probe
  std::uint32_t what_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(Availability) == 24);

/// The command line, arguments separated by a zero byte.
struct CommandLine {
  static constexpr RecordKind kKind = RecordKind::kCommandLine;
  EventWord header;
  std::uint32_t text_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(CommandLine) == 16);

/// A file with code, for functions known by address (-finstrument-functions) and native stacks: its
/// path as it was mapped, then the bytes of its build-id (none: it has none).
struct DefineModule {
  static constexpr RecordKind kKind = RecordKind::kDefineModule;
  EventWord header;
  std::uint32_t module;  // 1, 2, ...
  std::uint32_t path_bytes;
  std::uint32_t build_id_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineModule) == 24);

/// Where the function of a region begins. Its definition, which stands before this one, has no name
/// but "module+0xoffset": the reader looks for the symbol.
struct DefineCode {
  static constexpr RecordKind kKind = RecordKind::kDefineCode;
  EventWord header;
  std::uint32_t region;
  std::uint32_t module;
  std::uint64_t offset;  // address as the module's file numbers it: without where it was loaded
};
static_assert(sizeof(DefineCode) == 24);

/// Recording was switched off or on: in between this process has no event but the leaves of frames
/// that were open. A process that begins switched off says so.
struct Switched {
  static constexpr RecordKind kKind = RecordKind::kSwitched;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t on;      // 0 off, 1 on
  std::uint32_t region;  // 0: everything; else this region alone
};
static_assert(sizeof(Switched) == 24);

/// What events cost in this process, measured when it began: medians, in 1/256 ticks of the clock.
/// A visit is an enter and a leave with nothing between; its inner part is what its own times hold.
struct Calibration {
  static constexpr RecordKind kKind = RecordKind::kCalibration;
  EventWord header;
  std::uint32_t timed_visit;  // both events, back to back with others
  std::uint32_t timed_inner;
  std::uint32_t sampled_visit;  // a CountedEnter and its leave, pipeline drained
  std::uint32_t sampled_inner;
  std::uint32_t no_clock_visit;
  std::uint32_t counted_visit;
  std::uint32_t clock_read;  // one reading
  std::uint32_t reserved;
};
static_assert(sizeof(Calibration) == 40);

/// A ring (--max-bytes) dropped the first chunks of a thread. One record for a thread, rewritten in
/// place with each chunk, `chunks` last: a chunk whose sequence is lower is gone, whatever is left
/// of it.
struct Overwritten {
  static constexpr RecordKind kKind = RecordKind::kOverwritten;
  EventWord header;
  std::uint32_t thread;
  std::uint32_t reserved;
  std::uint64_t chunks;
  std::uint64_t events;      // in them
  std::uint64_t bytes;       // of them
  std::uint64_t from_ticks;  // the thread's events from here on are there
};
static_assert(sizeof(Overwritten) == 48);

/// What the filter did to the functions of one object; the filter's path follows. Records add up.
struct Filtered {
  static constexpr RecordKind kKind = RecordKind::kFiltered;
  EventWord header;
  std::uint32_t functions;  // that the object brought
  std::uint32_t filtered;   // of them
  std::uint32_t path_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(Filtered) == 24);

}  // namespace stipple

#endif
