// SPDX-License-Identifier: MIT
#include "runtime/mpi/message.h"

#include "runtime/mpi/handle_table.h"
#include "runtime/mpi/simulated.h"
#include "stipple/format.h"

namespace stipple::mpi {
namespace {

constexpr uint32_t kCompleted = 1;  // MpiRequestEnd::outcome
constexpr uint32_t kCancelled = 2;
constexpr uint32_t kFreed = 3;

constinit HandleTable<Request> requests;
constinit HandleTable<Request> matched;  // messages of MPI_(I)mprobe
constinit std::atomic<uint32_t> last_number{0};

std::uint64_t KeyOf(MPI_Request handle) { return reinterpret_cast<std::uint64_t>(handle); }
std::uint64_t KeyOf(MPI_Message handle) { return reinterpret_cast<std::uint64_t>(handle); }

/// Bytes of the message that a status tells of.
std::uint64_t BytesIn(const MPI_Status& status) {
#ifdef STIPPLE_CLASSIC_PMPI
  int bytes = 0;  // a simulator has no Get_elements_x, and no messages of 2 GiB
  STIPPLE_REAL(Get_count)(&status, predefined.byte, &bytes);
#else
  MPI_Count bytes = 0;
  STIPPLE_REAL(Get_elements_x)(&status, predefined.byte, &bytes);
#endif
  return bytes < 0 ? 0 : static_cast<std::uint64_t>(bytes);
}

void AppendSend(std::uint64_t ticks, const Request& send, uint32_t number) {
  if constexpr (kSimulated) NoteSent(send.bytes);
  Append(MpiSend{.header = 0,
                 .ticks = ticks,
                 .bytes = send.bytes,
                 .communicator = send.communicator,
                 .receiver = send.peer,
                 .tag = send.tag,
                 .request = number});
}

void AppendPost(std::uint64_t ticks, const Request& receive) {
  Append(MpiReceivePost{.header = 0,
                        .ticks = ticks,
                        .communicator = receive.communicator,
                        .request = receive.number});
}

void AppendReceive(std::uint64_t ticks, const Request& receive, const MPI_Status& status) {
  if constexpr (kSimulated) NoteReceived(BytesIn(status));
  Append(MpiReceive{.header = 0,
                    .ticks = ticks,
                    .bytes = BytesIn(status),
                    .communicator = receive.communicator,
                    .sender = status.MPI_SOURCE + receive.peer_offset,
                    .tag = status.MPI_TAG,
                    .request = receive.number});
}

void AppendEnd(std::uint64_t ticks, uint32_t number, uint32_t outcome) {
  Append(MpiRequestEnd{.header = 0, .ticks = ticks, .request = number, .outcome = outcome});
}

void RecordEnd(std::uint64_t ticks, const Request& request, const MPI_Status& status) {
  int cancelled = 0;
  if (request.kind != RequestKind::kCollective) {
    STIPPLE_REAL(Test_cancelled)(&status, &cancelled);
  }
  if (cancelled != 0) {
    AppendEnd(ticks, request.number, kCancelled);
  } else if (request.kind == RequestKind::kReceive) {
    AppendReceive(ticks, request, status);
  } else {
    AppendEnd(ticks, request.number, kCompleted);
  }
}

/// Takes the request out of the table, or lets a persistent one rest. By number: the handle may
/// already be another's.
void Retire(MPI_Request handle, const Request& request) {
  if (request.persistent) {
    requests.Update(KeyOf(handle), [&](Request& known) {
      if (known.number == request.number) known.active = false;
    });
  } else {
    requests.RemoveIf(KeyOf(handle),
                      [&](const Request& known) { return known.number == request.number; });
  }
}

bool Received(int result, const MPI_Status& status) {
  return (result == MPI_SUCCESS || result == MPI_ERR_TRUNCATE) &&
         status.MPI_SOURCE != MPI_PROC_NULL;
}

Request SendTo(const Communicator& on, int count, MPI_Datatype datatype, int dest, int tag) {
  return {.number = 0,
          .communicator = on.id,
          .bytes = BytesOf(count, datatype),
          .peer = PeerOf(on, dest),
          .tag = tag,
          .peer_offset = 0,
          .kind = RequestKind::kSend,
          .persistent = false,
          .active = true,
          .reported = false};
}

Request ReceiveOn(const Communicator& on, uint32_t number) {
  return {.number = number,
          .communicator = on.id,
          .bytes = 0,
          .peer = 0,
          .tag = 0,
          .peer_offset = on.peer_offset,
          .kind = RequestKind::kReceive,
          .persistent = false,
          .active = true,
          .reported = false};
}

}  // namespace

uint32_t NextRequestNumber() {
  uint32_t number = last_number.fetch_add(1, std::memory_order_relaxed) + 1;
  if (number == 0) number = last_number.fetch_add(1, std::memory_order_relaxed) + 1;
  return number;
}

std::uint64_t BytesOf(int count, MPI_Datatype datatype) {
  if (count <= 0 || datatype == nullptr || datatype == predefined.datatype_null) return 0;
  MPI_Count size = 0;
  STIPPLE_REAL(Type_size_x)(datatype, &size);
  return size < 0 ? 0 : static_cast<std::uint64_t>(count) * static_cast<std::uint64_t>(size);
}

void RecordSend(const Visit& visit, int count, MPI_Datatype datatype, int dest, int tag,
                MPI_Comm comm) {
  const Communicator on = Find(comm);
  if (!IsPeer(on, dest)) return;
  AppendSend(visit.EnterTicks(), SendTo(on, count, datatype, dest, tag), 0);
}

void RecordReceive(int result, MPI_Comm comm, const MPI_Status& status) {
  if (Received(result, status)) AppendReceive(stipple_ticks(), ReceiveOn(Find(comm), 0), status);
}

void RecordProbe(MPI_Comm comm, const MPI_Status& status) {
  if (status.MPI_SOURCE == MPI_PROC_NULL) return;
  const Communicator on = Find(comm);
  Append(MpiProbe{.header = 0,
                  .ticks = stipple_ticks(),
                  .bytes = BytesIn(status),
                  .communicator = on.id,
                  .sender = PeerOf(on, status.MPI_SOURCE),
                  .tag = status.MPI_TAG,
                  .reserved = 0});
}

Request PostSend(const Visit& visit, int count, MPI_Datatype datatype, int dest, int tag,
                 MPI_Comm comm) {
  const Communicator on = Find(comm);
  if (!IsPeer(on, dest)) return {};
  Request send = SendTo(on, count, datatype, dest, tag);
  send.number = NextRequestNumber();
  AppendSend(visit.EnterTicks(), send, send.number);
  return send;
}

Request PostReceive(const Visit& visit, int source, MPI_Comm comm) {
  if (source == MPI_PROC_NULL) return {};
  const Request receive = ReceiveOn(Find(comm), NextRequestNumber());
  AppendPost(visit.EnterTicks(), receive);
  return receive;
}

Request DescribeSend(int count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm) {
  const Communicator on = Find(comm);
  if (!IsPeer(on, dest)) return {};
  Request send = SendTo(on, count, datatype, dest, tag);
  send.number = NextRequestNumber();
  send.persistent = true;
  send.active = false;
  return send;
}

Request DescribeReceive(int source, MPI_Comm comm) {
  if (source == MPI_PROC_NULL) return {};
  Request receive = ReceiveOn(Find(comm), NextRequestNumber());
  receive.persistent = true;
  receive.active = false;
  return receive;
}

Request CollectiveRequest(uint32_t number) {
  Request collective = {};
  collective.number = number;
  collective.kind = RequestKind::kCollective;
  collective.active = true;
  return collective;
}

void Follow(int result, const Request& request, const MPI_Request* handle) {
  if (result != MPI_SUCCESS || request.number == 0 || *handle == predefined.request_null) return;
  if (*handle == predefined.request_empty && request.kind != RequestKind::kReceive) {
    return AppendEnd(stipple_ticks(), request.number, kCompleted);
  }
  requests.Put(KeyOf(*handle), request);
}

void RecordStart(const Visit& visit, int count, const MPI_Request* handles) {
  if (handles == nullptr) return;
  for (int i = 0; i < count; ++i) {
    Request request;
    bool known = requests.Update(KeyOf(handles[i]), [&](Request& resting) {
      resting.number = NextRequestNumber();
      resting.active = true;
      resting.reported = false;
      request = resting;
    });
    if (!known) continue;
    if (request.kind == RequestKind::kSend) {
      AppendSend(visit.EnterTicks(), request, request.number);
    } else {
      AppendPost(visit.EnterTicks(), request);
    }
  }
}

void RecordRequestFree(const MPI_Request* handle) {
  Request request;
  if (handle == nullptr || !requests.Get(KeyOf(*handle), &request)) return;
  requests.RemoveIf(KeyOf(*handle), [](const Request&) { return true; });
  if (request.active && !request.reported) AppendEnd(stipple_ticks(), request.number, kFreed);
}

void RecordMatch(MPI_Comm comm, MPI_Message message, const MPI_Status& status) {
  RecordProbe(comm, status);
  if (message == predefined.message_no_proc || message == predefined.message_null) return;
  const Request receive = ReceiveOn(Find(comm), NextRequestNumber());
  AppendPost(stipple_ticks(), receive);
  matched.Put(KeyOf(message), receive);
}

Request TakeMatch(const MPI_Message* message) {
  Request receive = {};
  if (message == nullptr || !matched.Get(KeyOf(*message), &receive)) return {};
  matched.RemoveIf(KeyOf(*message), [](const Request&) { return true; });
  return receive;
}

void RecordMatchedReceive(int result, const Request& request, const MPI_Status& status) {
  if (request.number != 0 && Received(result, status)) {
    AppendReceive(stipple_ticks(), request, status);
  }
}

Completion::Completion(int count, const MPI_Request* handles) noexcept
    : count_(count > 0 && handles != nullptr ? static_cast<std::size_t>(count) : 0),
      handles_(count_),
      known_(threads_may_race ? count_ : 0),
      statuses_(count_) {
  if (handles_.Data() == nullptr || known_.Data() == nullptr) count_ = 0;
  for (std::size_t i = 0; i < count_; ++i) handles_[i] = handles[i];
  if (!threads_may_race) return;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!requests.Get(KeyOf(handles_[i]), &known_[i])) known_[i].number = 0;
  }
}

MPI_Status* Completion::Statuses(MPI_Status* given) {
  if (given != MPI_STATUSES_IGNORE) return given;
  return count_ == 0 ? MPI_STATUSES_IGNORE : statuses_.Data();
}

bool Completion::Lookup(int index, Request* request) {
  const auto i = static_cast<std::size_t>(index);
  if (index < 0 || i >= count_) return false;
  if (threads_may_race) {
    *request = known_[i];
    return request->number != 0 && request->active;
  }
  return requests.Get(KeyOf(handles_[i]), request) && request->active;
}

void Completion::Ended(int index, const MPI_Status& status) {
  Request request;
  if (!Lookup(index, &request)) return;
  if (ticks_ == 0) ticks_ = stipple_ticks();
  if (!request.reported) RecordEnd(ticks_, request, status);
  Retire(handles_[static_cast<std::size_t>(index)], request);
}

void Completion::EndedSome(int count, const int* indices, const MPI_Status* statuses) {
  if (count == MPI_UNDEFINED || statuses == MPI_STATUSES_IGNORE) return;
  for (int i = 0; i < count; ++i) Ended(indices[i], statuses[i]);
}

void Completion::EndedAll(int result, const MPI_Status* statuses) {
  if (statuses == MPI_STATUSES_IGNORE) return;
  if (result != MPI_SUCCESS && result != MPI_ERR_IN_STATUS) return;
  for (std::size_t i = 0; i < count_; ++i) {
    if (result == MPI_ERR_IN_STATUS && statuses[i].MPI_ERROR == MPI_ERR_PENDING) continue;
    Ended(static_cast<int>(i), statuses[i]);
  }
}

void Completion::Seen(const MPI_Status& status) {
  Request request;
  if (!Lookup(0, &request) || request.reported) return;
  RecordEnd(stipple_ticks(), request, status);
  requests.Update(KeyOf(handles_[0]), [&](Request& known) {
    if (known.number == request.number) known.reported = true;
  });
}

}  // namespace stipple::mpi
