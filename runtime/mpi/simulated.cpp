// SPDX-License-Identifier: MIT
#include "runtime/mpi/simulated.h"

#include <atomic>
#include <cstddef>

#include "runtime/core/hooks.h"
#include "runtime/core/recorder.h"
#include "runtime/core/simulator.h"
#include "runtime/core/syscalls.h"
#include "runtime/mpi/call.h"
#include "stipple/format.h"

namespace stipple::mpi {
namespace {

/// Of the call that the rank is in.
struct Noted {
  std::uint32_t sends, receives;
  std::uint64_t send_ns, receive_ns;
  std::uint64_t send_bytes, receive_bytes;
};
constinit Noted noted{};

constexpr std::uint32_t kSendMsg = 46, kRecvMsg = 47;  // what they are on Linux

void AppendCall(const char* name, std::uint32_t number, std::uint64_t begin, std::uint64_t end,
                std::uint64_t bytes) {
  SystemCall record{};
  record.ticks = end;
  record.enter_ticks = begin;
  record.result = static_cast<std::int64_t>(bytes);
  record.number = number;
  record.name = stipple_define_name(name, "");
  Append(record);
}

/// Chunks of what the kernel tells, which have their own place in a stream.
class KernelChunk {
 public:
  void AppendSwitch(std::uint64_t out_ns, std::uint64_t in_ns) {
    constexpr std::uint64_t kWords = sizeof(ContextSwitch) / sizeof(EventWord);
    auto* place = reinterpret_cast<ContextSwitch*>(Room());
    if (place == nullptr) return;
    std::atomic_ref<EventWord> header(place->header);
    header.store(MakeHeader(ContextSwitch::kKind, kWords, false), std::memory_order_release);
    place->out_ns = out_ns;
    place->in_ns = in_ns;
    place->away_ns = in_ns - out_ns;
    place->reason = SwitchReason::kBlocked;
    place->count = 1;
    header.store(MakeHeader(ContextSwitch::kKind, kWords, true), std::memory_order_release);
  }

 private:
  char* Room() {
    constexpr std::size_t kBytes = sizeof(ContextSwitch);
    if (next_ == nullptr || next_ + kBytes > end_) {
      char* chunk = stipple_take_chunk(static_cast<std::uint32_t>(ChunkKind::kKernel), 0, GetTid(),
                                       sequence_, 0, kGranuleBytes);
      if (chunk == nullptr) return nullptr;
      ++sequence_;
      next_ = chunk + sizeof(ChunkHeader);
      end_ = chunk + kGranuleBytes;
    }
    char* place = next_;
    next_ += kBytes;
    return place;
  }

  char* next_ = nullptr;
  char* end_ = nullptr;
  std::uint64_t sequence_ = 0;
};
constinit KernelChunk kernel{};

void SayAvailable(const char* what) {
  Availability record{};
  record.available = 1;
  record.what_bytes = static_cast<std::uint32_t>(TextBytes(what));
  stipple_define(&record, static_cast<std::uint8_t>(Availability::kKind), sizeof record, what,
                 record.what_bytes);
}

/// Once.
void Begin() {
  static bool begun = false;
  if (begun) return;
  begun = true;
  SayAvailable("system calls");
  SayAvailable("switches");
  SayAvailable("transmissions");
}

void AppendTransmissions() {
  NetworkTime time{};
  while (NextTransmission(time)) {
    Transmission record{};
    record.ticks = stipple_ticks();
    record.begin_ticks = time.begin_ns;
    record.end_ticks = time.end_ns;
    record.bytes = time.bytes;
    record.receiver = time.receiver;
    Append(record);
  }
}

/// The last ones of a rank end when it has nothing more to call.
__attribute__((constructor)) void AskForTheEnd() {
  hooks.process_ending = [](Process&) {
    if (stipple_recording()) AppendTransmissions();
  };
}

}  // namespace

void NoteSent(std::uint64_t bytes) {
  ++noted.sends;
  noted.send_ns += SendNs(bytes);
  noted.send_bytes += bytes;
}

void NoteReceived(std::uint64_t bytes) {
  ++noted.receives;
  noted.receive_ns += ReceiveNs(bytes);
  noted.receive_bytes += bytes;
}

void RecordSystem(std::uint64_t enter_ticks) {
  Begin();
  const Noted now = noted;
  noted = {};
  const std::uint64_t leave_ticks = stipple_ticks();
  if (now.sends == 0 && now.receives == 0) return AppendTransmissions();
  // Of a call that did less than was expected, such as a message to oneself, nothing is made up.
  if (enter_ticks + now.send_ns + now.receive_ns > leave_ticks) return AppendTransmissions();
  const std::uint64_t out = enter_ticks + now.send_ns, in = leave_ticks - now.receive_ns;
  if (now.sends != 0) AppendCall("start send", kSendMsg, enter_ticks, out, now.send_bytes);
  if (now.receives != 0) {
    if (in > out) kernel.AppendSwitch(out, in);
    AppendCall("take message", kRecvMsg, in, leave_ticks, now.receive_bytes);
  }
  AppendTransmissions();
}

}  // namespace stipple::mpi
