// SPDX-License-Identifier: MIT
#include "analysis/stats/time_sums.h"

#include <algorithm>
#include <set>

#include "analysis/stats/analysis.h"
#include "analysis/trace/kernel.h"

namespace stipple {
namespace {

std::vector<CallSums> SumCalls(const Analysis& analysis, const Location& l) {
  const auto& calls = analysis.mpi.calls;
  std::vector<CallSums> sums;
  CallSums next;
  const auto first = std::ranges::lower_bound(calls, l.index, {}, &MpiCall::location);
  for (auto c = static_cast<std::size_t>(first - calls.begin());
       c < calls.size() && calls[c].location == l.index; ++c) {
    next.begin_ns = calls[c].begin_ns;
    sums.push_back(next);
    next.idle_ns += analysis.waits[c].idle_ns;
    next.mpi_ns += calls[c].end_ns - calls[c].begin_ns;
    next.begin_ns = calls[c].end_ns;
  }
  sums.push_back(next);
  return sums;
}

std::vector<KernelSums> SumKernel(const Array<CallSpan>& spans) {
  std::vector<KernelSums> sums;
  KernelSums next;
  for (const CallSpan& s : spans) {
    next.begin_ns = s.begin_ns;
    sums.push_back(next);
    next.kernel_ns += s.end_ns - s.begin_ns;
    next.begin_ns = s.end_ns;
  }
  sums.push_back(next);
  return sums;
}

void SumMessages(const Analysis& analysis, TimeSums& sums) {
  const std::vector<int> in_order = analysis.trace.RanksInOrder();
  const std::set<int> mains(in_order.begin(), in_order.end());
  std::vector<MessageSums> messages;
  for (std::size_t i = 0; i < analysis.mpi.sends.size(); ++i) {
    const SendEvent& s = analysis.mpi.sends[i];
    if (s.receive == kNoIndex || !mains.contains(s.channel.sender) ||
        !mains.contains(s.channel.receiver))
      continue;
    const std::int64_t complete_ns = analysis.mpi.receives[s.receive].complete_ns;
    messages.push_back({s.enter_ns, std::max(s.enter_ns, complete_ns), s.bytes, i});
  }
  std::ranges::stable_sort(messages, {}, &MessageSums::send_ns);
  std::vector<std::int64_t> completions;
  std::vector<std::int64_t> latest;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    completions.push_back(messages[i].until_ns);
    if (i % TimeSums::kBlock == 0) latest.push_back(messages[i].until_ns);
    latest.back() = std::max(latest.back(), messages[i].until_ns);
    bytes += std::exchange(messages[i].bytes_before, bytes);
  }
  std::ranges::sort(completions);
  sums.messages = std::move(messages);
  sums.completions = std::move(completions);
  sums.latest = std::move(latest);
}

/// Index of the last entry that begins at `time_ns` or before, looked for from `hint` on in growing
/// steps, so that neighbours in time are neighbours in memory; 0 if there is none.
template <class Sums>
std::size_t LastBefore(const Array<Sums>& sums, double time_ns, std::size_t hint) {
  const auto is_after = [&](std::size_t i) {
    return static_cast<double>(sums[i].begin_ns) > time_ns;
  };
  std::size_t low = hint < sums.size() && !is_after(hint) ? hint : 0;
  std::size_t step = 1;
  while (low + step < sums.size() && !is_after(low + step)) {
    low += step;
    step *= 2;
  }
  std::size_t high = std::min(low + step, sums.size());  // after, or the end
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (is_after(middle) ? high : low) = middle;
  }
  return low;
}

/// How far a sum that grows by `grows_ns` from its entry's begin on, then rests, has come.
double Grown(double since_ns, std::int64_t before_ns, std::int64_t after_ns) {
  return static_cast<double>(before_ns) +
         std::clamp(since_ns, 0.0, std::max(0.0, static_cast<double>(after_ns - before_ns)));
}

}  // namespace

TimeSums SumTimes(const Analysis& analysis) {
  const Trace& trace = analysis.trace;
  TimeSums sums;
  for (const Location& l : trace.locations()) {
    sums.calls.emplace_back();
    sums.kernel.emplace_back();
    if (!l.IsMain()) continue;
    sums.calls.back() = SumCalls(analysis, l);
    sums.kernel.back() = SumKernel(analysis.kernel[l.index]);
  }
  SumMessages(analysis, sums);
  return sums;
}

StateClock::StateClock(const Analysis& analysis, const Location& main)
    : main_(main),
      calls_(analysis.sums.calls[main.index]),
      kernel_(analysis.sums.kernel[main.index]),
      system_is_in_mpi_(SystemIsInMpi(analysis.trace)) {}

StateTimes StateClock::Before(double time_ns) {
  StateTimes times;
  double mpi = 0;
  if (calls_.size() > 1) {
    call_ = std::min(LastBefore(calls_, time_ns, call_), calls_.size() - 2);
    const CallSums& before = calls_[call_];
    const CallSums& after = calls_[call_ + 1];
    const double since = time_ns - static_cast<double>(before.begin_ns);
    times.idle = Grown(since, before.idle_ns, after.idle_ns);
    mpi = Grown(since, before.mpi_ns, after.mpi_ns);
    times.message = mpi - times.idle;
  }
  if (kernel_.size() > 1) {
    span_ = std::min(LastBefore(kernel_, time_ns, span_), kernel_.size() - 2);
    times.system = Grown(time_ns - static_cast<double>(kernel_[span_].begin_ns),
                         kernel_[span_].kernel_ns, kernel_[span_ + 1].kernel_ns);
  }
  const double there =
      std::clamp(time_ns, static_cast<double>(main_.begin_ns), static_cast<double>(main_.end_ns)) -
      static_cast<double>(main_.begin_ns);
  times.user = there - mpi - times.system;
  if (system_is_in_mpi_) {
    times.user = there - mpi;
    times.message -= times.system;
  }
  return times;
}

std::size_t SentBefore(const TimeSums& sums, double time_ns) {
  const auto at = std::ranges::lower_bound(sums.messages, time_ns, {}, [](const MessageSums& m) {
    return static_cast<double>(m.send_ns);
  });
  return static_cast<std::size_t>(at - sums.messages.begin());
}

std::uint64_t BytesOfFirst(const Analysis& analysis, std::size_t messages) {
  const Array<MessageSums>& all = analysis.sums.messages;
  if (messages < all.size()) return all[messages].bytes_before;
  return all.empty() ? 0 : all.back().bytes_before + analysis.mpi.sends[all.back().send].bytes;
}

namespace {

std::size_t SentUntil(const TimeSums& sums, double end_ns) {
  const auto at = std::ranges::upper_bound(sums.messages, end_ns, {}, [](const MessageSums& m) {
    return static_cast<double>(m.send_ns);
  });
  return static_cast<std::size_t>(at - sums.messages.begin());
}

}  // namespace

std::size_t MessagesIn(const TimeSums& sums, double begin_ns, double end_ns) {
  // What was complete before the begin had been sent before the end.
  const auto over = std::ranges::lower_bound(
      sums.completions, begin_ns, {}, [](std::int64_t ns) { return static_cast<double>(ns); });
  return SentUntil(sums, end_ns) - static_cast<std::size_t>(over - sums.completions.begin());
}

std::vector<std::size_t> ListMessagesIn(const TimeSums& sums, double begin_ns, double end_ns) {
  const std::size_t count = MessagesIn(sums, begin_ns, end_ns);
  const std::size_t first = SentBefore(sums, begin_ns);
  std::vector<std::size_t> found;
  for (std::size_t i = first, end = SentUntil(sums, end_ns); i < end; ++i)
    found.push_back(sums.messages[i].send);
  // Then those that were under way at the begin, back to the first of them.
  for (std::size_t i = first; i > 0 && found.size() < count;) {
    const std::size_t block = (i - 1) / TimeSums::kBlock;
    if (static_cast<double>(sums.latest[block]) < begin_ns) {
      i = block * TimeSums::kBlock;
      continue;
    }
    --i;
    if (static_cast<double>(sums.messages[i].until_ns) >= begin_ns)
      found.push_back(sums.messages[i].send);
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace stipple
