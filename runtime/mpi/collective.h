// SPDX-License-Identifier: MIT
// How many bytes a collective moves, from this rank's point of view.
//
// One model for all: a contribution counts once for each rank that its value goes to, the sender
// itself included, whatever the algorithm. So over all ranks of a communicator sent equals received
// (but for reductions over data of unequal type maps). MPI_IN_PLACE data counts as if it had been
// sent to itself. In an intercommunicator data goes to the other group only.
//
// Arguments that MPI calls "significant only at root" are not looked at elsewhere: they may be
// garbage there.
#ifndef STIPPLE_RUNTIME_MPI_COLLECTIVE_H
#define STIPPLE_RUNTIME_MPI_COLLECTIVE_H

#include "runtime/mpi/call.h"
#include "runtime/mpi/communicator.h"

namespace stipple::mpi {

/// One buffer argument: data of one count and type.
struct Piece {
  const void* data;
  int count;
  MPI_Datatype type;
};

/// One buffer argument of a v- or w-form: a count for each peer; `types` is null if all have
/// `type`.
struct Pieces {
  const void* data;
  const int* counts;
  MPI_Datatype type;
  const MPI_Datatype* types;
};

/// Bytes sent and received by this rank; root as the program gave it, or kNoRoot.
struct Traffic {
  std::uint64_t sent;
  std::uint64_t received;
  int root;
};
inline constexpr int kNoRoot = MPI_PROC_NULL;

Traffic Barrier();
Traffic Bcast(const Communicator& on, Piece data, int root);
Traffic Reduce(const Communicator& on, Piece data, int root);
Traffic Allreduce(const Communicator& on, Piece data);
Traffic Gather(const Communicator& on, Piece send, Piece receive, int root);
Traffic Gatherv(const Communicator& on, Piece send, Pieces receive, int root);
Traffic Scatter(const Communicator& on, Piece send, Piece receive, int root);
Traffic Scatterv(const Communicator& on, Pieces send, Piece receive, int root);
Traffic Allgather(const Communicator& on, Piece send, Piece receive);
Traffic Allgatherv(const Communicator& on, Piece send, Pieces receive);
Traffic Alltoall(const Communicator& on, Piece send, Piece receive);
Traffic Alltoallv(const Communicator& on, Pieces send, Pieces receive);
Traffic ReduceScatter(const Communicator& on, Pieces receive);
Traffic ReduceScatterBlock(const Communicator& on, Piece receive);
Traffic Scan(const Communicator& on, Piece data);
Traffic Exscan(const Communicator& on, Piece data);

/// Appends the record of a collective that has just been entered; request 0: blocking.
void RecordCollective(const Visit& visit, const Communicator& on, const Traffic& traffic,
                      uint32_t request);

}  // namespace stipple::mpi

#endif
