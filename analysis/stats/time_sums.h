// SPDX-License-Identifier: MIT
// How a rank had divided its time up to each of its MPI calls, and what all had sent up to each
// message: the share of a state in any column of any zoom is the difference of two sums, each found
// by a search, so a picture costs what its columns cost and not what the run did
// (docs/decisions/0010).
#ifndef STIPPLE_ANALYSIS_STATS_TIME_SUMS_H
#define STIPPLE_ANALYSIS_STATS_TIME_SUMS_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/trace/array.h"
#include "analysis/trace/trace.h"

namespace stipple {

struct Analysis;

/// An MPI call of a main thread and the sums before it. One more follows the last call.
struct CallSums {
  std::int64_t begin_ns = 0;
  std::int64_t idle_ns = 0;
  std::int64_t mpi_ns = 0;  // in calls, idle or not
};

/// A span in the kernel's hands, likewise.
struct KernelSums {
  std::int64_t begin_ns = 0;
  std::int64_t kernel_ns = 0;
};

/// A matched message between two main threads, by the time of its send.
struct MessageSums {
  std::int64_t send_ns = 0;
  std::int64_t until_ns = 0;       // complete; not before the send
  std::uint64_t bytes_before = 0;  // of the messages before it
  std::uint64_t send = 0;          // of mpi.sends
};

struct TimeSums {
  static constexpr std::size_t kBlock = 64;

  std::vector<Array<CallSums>> calls;     // by location; none of threads that are not main
  std::vector<Array<KernelSums>> kernel;  // likewise
  Array<MessageSums> messages;
  Array<std::int64_t> completions;  // until_ns of all, in order
  Array<std::int64_t> latest;       // until_ns of the last to end of each kBlock messages
};

/// Of an analysis that has its MPI activity, waits and kernel time.
TimeSums SumTimes(const Analysis& analysis);

/// Nanoseconds that a rank had spent in each state.
struct StateTimes {
  double user = 0;
  double system = 0;
  double message = 0;
  double idle = 0;
};

/// Reads the sums of one main thread. Quick when it is asked in the order of time.
class StateClock {
 public:
  StateClock(const Analysis& analysis, const Location& main);
  StateTimes Before(double time_ns);

 private:
  const Location& main_;
  const Array<CallSums>& calls_;
  const Array<KernelSums>& kernel_;
  bool system_is_in_mpi_;
  std::size_t call_ = 0;  // of the last question
  std::size_t span_ = 0;
};

/// How many of the messages were sent before `time_ns`.
std::size_t SentBefore(const TimeSums& sums, double time_ns);
/// Bytes of the first `messages` of them.
std::uint64_t BytesOfFirst(const Analysis& analysis, std::size_t messages);
/// How many were under way at any time of [begin_ns, end_ns].
std::size_t MessagesIn(const TimeSums& sums, double begin_ns, double end_ns);
/// Those, as indices of mpi.sends, ascending.
std::vector<std::size_t> ListMessagesIn(const TimeSums& sums, double begin_ns, double end_ns);

}  // namespace stipple

#endif
