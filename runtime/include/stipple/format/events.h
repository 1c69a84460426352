// SPDX-License-Identifier: MIT
// Of the format: records that happened at a time.
#ifndef STIPPLE_FORMAT_EVENTS_H
#define STIPPLE_FORMAT_EVENTS_H

#include <cstdint>

#include "stipple/format/words.h"

namespace stipple {

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

/// A message was in the network, as the simulator of the machine says (flavour sim): one of this
/// rank's, in the order of their ends. `ticks` is when it was told.
struct Transmission {
  static constexpr RecordKind kKind = RecordKind::kTransmission;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t begin_ticks;  // its first byte left
  std::uint64_t end_ticks;    // its last one was there
  std::uint64_t bytes;        // with what the network adds
  std::int32_t receiver;      // world rank
  std::uint32_t reserved;
};
static_assert(sizeof(Transmission) == 48);

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

}  // namespace stipple

#endif
