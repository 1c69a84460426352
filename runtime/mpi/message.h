// SPDX-License-Identifier: MIT
// Point to point: the records of sends, receives and probes, and the requests in between.
//
// Every activation of a request has a number of its own, unique within the process, drawn before
// the call: the reader matches receives in the order of their posts, not of their completions.
#ifndef STIPPLE_RUNTIME_MPI_MESSAGE_H
#define STIPPLE_RUNTIME_MPI_MESSAGE_H

#include "runtime/mpi/call.h"
#include "runtime/mpi/communicator.h"
#include "runtime/mpi/pages.h"

namespace stipple::mpi {

/// Number of the next activation of a request; never 0.
uint32_t NextRequestNumber();

/// Bytes of `count` elements; 0 if that is not a valid question, for the real call to complain
/// about.
std::uint64_t BytesOf(int count, MPI_Datatype datatype);

/// The program's status, or our own where it asked for none.
inline MPI_Status* StatusOr(MPI_Status* status, MPI_Status* own) {
  return status == MPI_STATUS_IGNORE ? own : status;
}

enum class RequestKind : std::uint8_t { kSend, kReceive, kCollective };

/// A request that the layer follows.
struct Request {
  uint32_t number;  // of the current activation; 0: not to be followed (MPI_PROC_NULL)
  uint32_t communicator;
  std::uint64_t bytes;  // of a send
  int32_t peer;         // of a send, as recorded
  int32_t tag;
  int32_t peer_offset;  // of a receive: Communicator::peer_offset
  RequestKind kind;
  bool persistent;
  bool active;    // started and not complete
  bool reported;  // complete by MPI_Request_get_status, which leaves it to be completed again
};

// Blocking calls. ------------------------------------------------------------------------------

void RecordSend(const Visit& visit, int count, MPI_Datatype datatype, int dest, int tag,
                MPI_Comm comm);
/// `result`: what the call returned; a truncated message has been received all the same.
void RecordReceive(int result, MPI_Comm comm, const MPI_Status& status);
void RecordProbe(MPI_Comm comm, const MPI_Status& status);

// Requests. ------------------------------------------------------------------------------------

/// Records a send that is about to be posted.
Request PostSend(const Visit& visit, int count, MPI_Datatype datatype, int dest, int tag,
                 MPI_Comm comm);
/// Records the post of a receive that is about to be posted.
Request PostReceive(const Visit& visit, int source, MPI_Comm comm);
/// A persistent request, not started.
Request DescribeSend(int count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm);
Request DescribeReceive(int source, MPI_Comm comm);
/// A collective that was recorded under `number`.
Request CollectiveRequest(uint32_t number);

/// After the posting call: follows the request it made, if it made one. What was complete at once
/// has ended: MPI then hands out one handle that all such requests share.
void Follow(int result, const Request& request, const MPI_Request* handle);

/// Records what MPI_Start(all) is about to start.
void RecordStart(const Visit& visit, int count, const MPI_Request* handles);

/// Before MPI_Request_free.
void RecordRequestFree(const MPI_Request* handle);

// Matched probes: the message is received from the moment of the match. --------------------------

void RecordMatch(MPI_Comm comm, MPI_Message message, const MPI_Status& status);
/// What MPI_(I)mrecv is about to receive; number 0 if nothing.
Request TakeMatch(const MPI_Message* message);
void RecordMatchedReceive(int result, const Request& request, const MPI_Status& status);

// Completion. ------------------------------------------------------------------------------------

/// The requests of one Wait or Test call: remembers the handles before MPI overwrites them, lends
/// statuses where the program wants none, and records what completed.
class Completion {
 public:
  Completion(int count, const MPI_Request* handles) noexcept;

  /// The program's statuses, or own ones for MPI_STATUSES_IGNORE.
  MPI_Status* Statuses(MPI_Status* given);
  /// Request `index` of the call is complete. All of one call carry one time, read once.
  void Ended(int index, const MPI_Status& status);
  /// The `count` requests named by `indices` are complete, statuses in the same order.
  void EndedSome(int count, const int* indices, const MPI_Status* statuses);
  /// The call is for all its requests.
  void EndedAll(int result, const MPI_Status* statuses);
  /// MPI_Request_get_status found request 0 complete and left it as it is.
  void Seen(const MPI_Status& status);

 private:
  static constexpr std::size_t kInline = 64;
  bool Lookup(int index, Request* request);

  std::size_t count_;
  std::uint64_t ticks_ = 0;
  Scratch<MPI_Request, kInline> handles_;
  // Where threads may race, a handle may be another request's by the time the call returns, so
  // what it stood for is looked up before.
  Scratch<Request, kInline> known_;
  Scratch<MPI_Status, kInline> statuses_;
};

}  // namespace stipple::mpi

#endif
