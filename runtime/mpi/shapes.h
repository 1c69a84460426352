// SPDX-License-Identifier: MIT
// How each shape of calls.def is recorded: what to do before the real call and what after it.
//
// The code here stands inside the wrapper function and reads its parameters by name.
#ifndef STIPPLE_RUNTIME_MPI_SHAPES_H
#define STIPPLE_RUNTIME_MPI_SHAPES_H

#include "runtime/mpi/call.h"
#include "runtime/mpi/collective.h"
#include "runtime/mpi/communicator.h"
#include "runtime/mpi/message.h"
#include "runtime/mpi/world.h"

#define STIPPLE_EXPORT __attribute__((visibility("default")))

/// MPI_name is another name of PMPI_name; the classic way has no PMPI_name of its own.
#ifdef STIPPLE_CLASSIC_PMPI
#define STIPPLE_ALIAS(name)
#else
#define STIPPLE_ALIAS(name)                                  \
  extern "C" STIPPLE_EXPORT decltype(PMPI_##name) MPI_##name \
      __attribute__((alias("PMPI"                            \
                           "_" #name)));
#endif

/// A wrapper: `before` and `after` surround the real call and may use `visit` and `returned`.
#define STIPPLE_WRAP(name, parameters, arguments, before, after)   \
  extern "C" STIPPLE_EXPORT int STIPPLE_WRAPPER(name) parameters { \
    auto* const real = STIPPLE_REAL(name);                         \
    if (real == nullptr) [[unlikely]]                              \
      return MPI_ERR_OTHER;                                        \
    Visit visit(CallIndex::k##name);                               \
    if (!visit.Recorded()) return real arguments;                  \
    before;                                                        \
    const int returned = real arguments;                           \
    after;                                                         \
    visit.Leave();                                                 \
    return returned;                                               \
  }                                                                \
  STIPPLE_ALIAS(name)

// The classic way leaves plain calls alone: another MPI's prototypes may differ in them.
#ifdef STIPPLE_CLASSIC_PMPI
#define STIPPLE_SHAPE_plain(name, parameters, arguments)
#else
#define STIPPLE_SHAPE_plain(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, , )
#endif

// Beginning and end: on every rank, even if this one does not record.

#define STIPPLE_EDGE(name, parameters, arguments, before, after)   \
  extern "C" STIPPLE_EXPORT int STIPPLE_WRAPPER(name) parameters { \
    auto* const real = STIPPLE_REAL(name);                         \
    if (real == nullptr) [[unlikely]]                              \
      return MPI_ERR_OTHER;                                        \
    Visit visit(CallIndex::k##name);                               \
    before;                                                        \
    const int returned = real arguments;                           \
    after;                                                         \
    if (visit.Recorded()) visit.Leave();                           \
    return returned;                                               \
  }                                                                \
  STIPPLE_ALIAS(name)

#define STIPPLE_SHAPE_init(name, parameters, arguments) \
  STIPPLE_EDGE(name, parameters, arguments, , BeginWorld(returned, MPI_THREAD_SINGLE))
#define STIPPLE_SHAPE_init_thread(name, parameters, arguments) \
  STIPPLE_EDGE(name, parameters, arguments, , BeginWorld(returned, *provided))
#define STIPPLE_SHAPE_finalize(name, parameters, arguments) \
  STIPPLE_EDGE(name, parameters, arguments, EndWorld(), if constexpr (kSimulated) EndSimulation())

// Point to point.

#define STIPPLE_SHAPE_send(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, RecordSend(visit, count, datatype, dest, tag, comm), )
#define STIPPLE_SHAPE_isend(name, parameters, arguments)                                 \
  STIPPLE_WRAP(name, parameters, arguments,                                              \
               const Request posted = PostSend(visit, count, datatype, dest, tag, comm), \
               Follow(returned, posted, request))
#define STIPPLE_SHAPE_send_init(name, parameters, arguments)                             \
  STIPPLE_WRAP(name, parameters, arguments,                                              \
               const Request described = DescribeSend(count, datatype, dest, tag, comm), \
               Follow(returned, described, request))
#define STIPPLE_SHAPE_receive(name, parameters, arguments)  \
  STIPPLE_WRAP(name, parameters, arguments, MPI_Status own; \
               status = StatusOr(status, &own), RecordReceive(returned, comm, *status))
#define STIPPLE_SHAPE_ireceive(name, parameters, arguments)             \
  STIPPLE_WRAP(name, parameters, arguments,                             \
               const Request posted = PostReceive(visit, source, comm), \
               Follow(returned, posted, request))
#define STIPPLE_SHAPE_receive_init(name, parameters, arguments)         \
  STIPPLE_WRAP(name, parameters, arguments,                             \
               const Request described = DescribeReceive(source, comm), \
               Follow(returned, described, request))
#define STIPPLE_SHAPE_sendrecv(name, parameters, arguments)                                     \
  STIPPLE_WRAP(                                                                                 \
      name, parameters, arguments, RecordSend(visit, sendcount, sendtype, dest, sendtag, comm); \
      MPI_Status own; status = StatusOr(status, &own), RecordReceive(returned, comm, *status))
#define STIPPLE_SHAPE_sendrecv_replace(name, parameters, arguments)                         \
  STIPPLE_WRAP(                                                                             \
      name, parameters, arguments, RecordSend(visit, count, datatype, dest, sendtag, comm); \
      MPI_Status own; status = StatusOr(status, &own), RecordReceive(returned, comm, *status))
#define STIPPLE_SHAPE_probe(name, parameters, arguments)                                     \
  STIPPLE_WRAP(name, parameters, arguments, MPI_Status own; status = StatusOr(status, &own), \
                                                            if (returned == MPI_SUCCESS)     \
                                                                RecordProbe(comm, *status))
#define STIPPLE_SHAPE_iprobe(name, parameters, arguments)   \
  STIPPLE_WRAP(name, parameters, arguments, MPI_Status own; \
               status = StatusOr(status, &own),             \
               if (returned == MPI_SUCCESS && *flag != 0) RecordProbe(comm, *status))
#define STIPPLE_SHAPE_mprobe(name, parameters, arguments)   \
  STIPPLE_WRAP(name, parameters, arguments, MPI_Status own; \
               status = StatusOr(status, &own),             \
               if (returned == MPI_SUCCESS) RecordMatch(comm, *message, *status))
#define STIPPLE_SHAPE_improbe(name, parameters, arguments)  \
  STIPPLE_WRAP(name, parameters, arguments, MPI_Status own; \
               status = StatusOr(status, &own),             \
               if (returned == MPI_SUCCESS && *flag != 0) RecordMatch(comm, *message, *status))
#define STIPPLE_SHAPE_mreceive(name, parameters, arguments)                           \
  STIPPLE_WRAP(name, parameters, arguments, const Request taken = TakeMatch(message); \
               MPI_Status own;                                                        \
               status = StatusOr(status, &own), RecordMatchedReceive(returned, taken, *status))
#define STIPPLE_SHAPE_imreceive(name, parameters, arguments)                          \
  STIPPLE_WRAP(name, parameters, arguments, const Request taken = TakeMatch(message), \
               Follow(returned, taken, request))
#define STIPPLE_SHAPE_start(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, RecordStart(visit, 1, request), )
#define STIPPLE_SHAPE_startall(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, RecordStart(visit, count, requests), )

// Completion. A single request is complete when the call succeeds or has given it up.

#define STIPPLE_SHAPE_wait(name, parameters, arguments)                          \
  STIPPLE_WRAP(                                                                  \
      name, parameters, arguments, Completion ended(1, request); MPI_Status own; \
      status = StatusOr(status, &own),                                           \
      if (returned == MPI_SUCCESS || *request == predefined.request_null) ended.Ended(0, *status))
#define STIPPLE_SHAPE_test(name, parameters, arguments)                                        \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(1, request); MPI_Status own;      \
               status = StatusOr(status, &own),                                                \
               if (returned == MPI_SUCCESS ? *flag != 0 : *request == predefined.request_null) \
                   ended.Ended(0, *status))
#define STIPPLE_SHAPE_waitall(name, parameters, arguments)                     \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(count, requests); \
               statuses = ended.Statuses(statuses), ended.EndedAll(returned, statuses))
#define STIPPLE_SHAPE_testall(name, parameters, arguments)                     \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(count, requests); \
               statuses = ended.Statuses(statuses),                            \
               if (returned != MPI_SUCCESS || *flag != 0) ended.EndedAll(returned, statuses))
#define STIPPLE_SHAPE_waitany(name, parameters, arguments)                                     \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(count, requests); MPI_Status own; \
               status = StatusOr(status, &own),                                                \
               if (returned == MPI_SUCCESS) ended.Ended(*index, *status))
#define STIPPLE_SHAPE_testany(name, parameters, arguments)                                     \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(count, requests); MPI_Status own; \
               status = StatusOr(status, &own),                                                \
               if (returned == MPI_SUCCESS && *flag != 0) ended.Ended(*index, *status))
#define STIPPLE_SOME_ENDED                                      \
  if (returned == MPI_SUCCESS || returned == MPI_ERR_IN_STATUS) \
  ended.EndedSome(*outcount, indices, statuses)
#define STIPPLE_SHAPE_waitsome(name, parameters, arguments)                    \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(count, requests); \
               statuses = ended.Statuses(statuses), STIPPLE_SOME_ENDED)
#define STIPPLE_SHAPE_testsome(name, parameters, arguments) \
  STIPPLE_SHAPE_waitsome(name, parameters, arguments)
#define STIPPLE_SHAPE_request_get_status(name, parameters, arguments)                      \
  STIPPLE_WRAP(name, parameters, arguments, Completion ended(1, &request); MPI_Status own; \
               status = StatusOr(status, &own),                                            \
               if (returned == MPI_SUCCESS && *flag != 0) ended.Seen(*status))
#define STIPPLE_SHAPE_request_free(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, RecordRequestFree(request), )

// Communicators, windows, files. Making and ending them, and some that is done with them, is done
// by all of their ranks: collectives that move nothing.

#define STIPPLE_MEET(on) RecordCollective(visit, on, Barrier(), 0)
#define STIPPLE_SHAPE_comm_create(name, parameters, arguments)        \
  STIPPLE_WRAP(name, parameters, arguments, STIPPLE_MEET(Find(comm)), \
               if (returned == MPI_SUCCESS) CommunicatorCreated(comm, *newcomm))
#define STIPPLE_SHAPE_comm_idup(name, parameters, arguments)                             \
  STIPPLE_WRAP(name, parameters, arguments, const uint32_t number = NextRequestNumber(); \
               RecordCollective(visit, Find(comm), Barrier(), number),                   \
               if (returned == MPI_SUCCESS) CommunicatorCreated(comm, *newcomm);         \
               Follow(returned, CollectiveRequest(number), request))
#define STIPPLE_SHAPE_comm_create_group(name, parameters, arguments) \
  STIPPLE_WRAP(                                                      \
      name, parameters, arguments, , if (returned == MPI_SUCCESS) {  \
        CommunicatorCreatedByGroup(comm, tag, *newcomm);             \
        STIPPLE_MEET(Find(*newcomm));                                \
      })
#define STIPPLE_END(name, parameters, arguments, object)                 \
  STIPPLE_WRAP(name, parameters, arguments, const auto handle = *object; \
               const Communicator known = Forget(handle);                \
               STIPPLE_MEET(known), if (returned != MPI_SUCCESS) Remember(handle, known))
#define STIPPLE_SHAPE_comm_free(name, parameters, arguments) \
  STIPPLE_END(name, parameters, arguments, comm)

#ifdef STIPPLE_CLASSIC_PMPI  // as plain ones
#define STIPPLE_SHAPE_comm_from(name, parameters, arguments)
#define STIPPLE_SHAPE_comm_join(name, parameters, arguments)
#define STIPPLE_SHAPE_comm_between(name, parameters, arguments)
#define STIPPLE_SHAPE_win_create(name, parameters, arguments)
#define STIPPLE_SHAPE_win_collective(name, parameters, arguments)
#define STIPPLE_SHAPE_win_free(name, parameters, arguments)
#define STIPPLE_SHAPE_file_open(name, parameters, arguments)
#define STIPPLE_SHAPE_file_collective(name, parameters, arguments)
#define STIPPLE_SHAPE_file_icollective(name, parameters, arguments)
#define STIPPLE_SHAPE_file_close(name, parameters, arguments)
#else
#define STIPPLE_SHAPE_comm_from(name, parameters, arguments)          \
  STIPPLE_WRAP(name, parameters, arguments, STIPPLE_MEET(Find(comm)), \
               if (returned == MPI_SUCCESS) CommunicatorCreatedBetween(*newcomm))
#define STIPPLE_SHAPE_comm_join(name, parameters, arguments)        \
  STIPPLE_WRAP(                                                     \
      name, parameters, arguments, , if (returned == MPI_SUCCESS) { \
        CommunicatorCreatedBetween(*newcomm);                       \
        STIPPLE_MEET(Find(*newcomm));                               \
      })
#define STIPPLE_SHAPE_comm_between(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, ,                   \
               if (returned == MPI_SUCCESS) CommunicatorCreatedBetween(*newcomm))

#define STIPPLE_SHAPE_win_create(name, parameters, arguments)         \
  STIPPLE_WRAP(name, parameters, arguments, STIPPLE_MEET(Find(comm)), \
               if (returned == MPI_SUCCESS) SharedCreated(comm, *win))
#define STIPPLE_SHAPE_win_collective(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, STIPPLE_MEET(FindShared(win)), )
#define STIPPLE_SHAPE_win_free(name, parameters, arguments) \
  STIPPLE_END(name, parameters, arguments, win)
#define STIPPLE_SHAPE_file_open(name, parameters, arguments)          \
  STIPPLE_WRAP(name, parameters, arguments, STIPPLE_MEET(Find(comm)), \
               if (returned == MPI_SUCCESS) SharedCreated(comm, *fh))
#define STIPPLE_SHAPE_file_collective(name, parameters, arguments) \
  STIPPLE_WRAP(name, parameters, arguments, STIPPLE_MEET(FindShared(fh)), )
#define STIPPLE_SHAPE_file_icollective(name, parameters, arguments)                      \
  STIPPLE_WRAP(name, parameters, arguments, const uint32_t number = NextRequestNumber(); \
               RecordCollective(visit, FindShared(fh), Barrier(), number),               \
               Follow(returned, CollectiveRequest(number), request))
#define STIPPLE_SHAPE_file_close(name, parameters, arguments) \
  STIPPLE_END(name, parameters, arguments, fh)
#endif

// Collectives: the traffic of each rule, from the parameters' names.

#define STIPPLE_SEND_PIECE (Piece{sendbuf, sendcount, sendtype})
#define STIPPLE_RECEIVE_PIECE (Piece{recvbuf, recvcount, recvtype})
#define STIPPLE_SEND_PIECES (Pieces{sendbuf, sendcounts, sendtype, nullptr})
#define STIPPLE_RECEIVE_PIECES (Pieces{recvbuf, recvcounts, recvtype, nullptr})
#define STIPPLE_TRAFFIC_barrier Barrier()
#define STIPPLE_TRAFFIC_bcast Bcast(on, {buffer, count, datatype}, root)
#define STIPPLE_TRAFFIC_reduce Reduce(on, {sendbuf, count, datatype}, root)
#define STIPPLE_TRAFFIC_allreduce Allreduce(on, {sendbuf, count, datatype})
#define STIPPLE_TRAFFIC_gather Gather(on, STIPPLE_SEND_PIECE, STIPPLE_RECEIVE_PIECE, root)
#define STIPPLE_TRAFFIC_gatherv Gatherv(on, STIPPLE_SEND_PIECE, STIPPLE_RECEIVE_PIECES, root)
#define STIPPLE_TRAFFIC_scatter Scatter(on, STIPPLE_SEND_PIECE, STIPPLE_RECEIVE_PIECE, root)
#define STIPPLE_TRAFFIC_scatterv Scatterv(on, STIPPLE_SEND_PIECES, STIPPLE_RECEIVE_PIECE, root)
#define STIPPLE_TRAFFIC_allgather Allgather(on, STIPPLE_SEND_PIECE, STIPPLE_RECEIVE_PIECE)
#define STIPPLE_TRAFFIC_allgatherv Allgatherv(on, STIPPLE_SEND_PIECE, STIPPLE_RECEIVE_PIECES)
#define STIPPLE_TRAFFIC_alltoall Alltoall(on, STIPPLE_SEND_PIECE, STIPPLE_RECEIVE_PIECE)
#define STIPPLE_TRAFFIC_alltoallv Alltoallv(on, STIPPLE_SEND_PIECES, STIPPLE_RECEIVE_PIECES)
#define STIPPLE_TRAFFIC_alltoallw                          \
  Alltoallv(on, {sendbuf, sendcounts, nullptr, sendtypes}, \
            {recvbuf, recvcounts, nullptr, recvtypes})
#define STIPPLE_TRAFFIC_reduce_scatter ReduceScatter(on, {recvbuf, recvcounts, datatype, nullptr})
#define STIPPLE_TRAFFIC_reduce_scatter_block ReduceScatterBlock(on, {recvbuf, recvcount, datatype})
#define STIPPLE_TRAFFIC_scan Scan(on, {sendbuf, count, datatype})
#define STIPPLE_TRAFFIC_exscan Exscan(on, {sendbuf, count, datatype})

#define STIPPLE_WRAP_COLLECTIVE(rule, name, parameters, arguments)              \
  STIPPLE_WRAP(name, parameters, arguments, const Communicator on = Find(comm); \
               RecordCollective(visit, on, STIPPLE_TRAFFIC_##rule, 0), )
#define STIPPLE_WRAP_ICOLLECTIVE(rule, name, parameters, arguments)             \
  STIPPLE_WRAP(name, parameters, arguments, const Communicator on = Find(comm); \
               const uint32_t number = NextRequestNumber();                     \
               RecordCollective(visit, on, STIPPLE_TRAFFIC_##rule, number),     \
               Follow(returned, CollectiveRequest(number), request))

#endif
