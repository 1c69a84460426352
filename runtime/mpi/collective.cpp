// SPDX-License-Identifier: MIT
#include "runtime/mpi/collective.h"

#include "runtime/mpi/message.h"
#include "stipple/format.h"

namespace stipple::mpi {
namespace {

/// What a rank does in a rooted collective. In an intercommunicator the root sits in one group and
/// the members are the other; the root's fellows only look on.
struct Role {
  bool root;
  bool member;
};

Role RoleIn(const Communicator& on, int root) {
  if (on.between) return {root == MPI_ROOT, root != MPI_ROOT && root != MPI_PROC_NULL};
  return {root == on.rank, true};
}

std::uint64_t PeersOf(const Communicator& on) { return static_cast<std::uint64_t>(on.peer_count); }

bool InPlace(const void* data) { return data == MPI_IN_PLACE; }

std::uint64_t BytesOf(const Piece& piece) { return mpi::BytesOf(piece.count, piece.type); }

std::uint64_t BytesOf(const Pieces& pieces, int peer) {
  if (pieces.counts == nullptr) return 0;
  return mpi::BytesOf(pieces.counts[peer],
                      pieces.types == nullptr ? pieces.type : pieces.types[peer]);
}

std::uint64_t SumOf(const Communicator& on, const Pieces& pieces) {
  if (pieces.counts == nullptr) return 0;
  std::uint64_t sum = 0;
  if (pieces.types != nullptr) {
    for (int peer = 0; peer < on.peer_count; ++peer) sum += BytesOf(pieces, peer);
    return sum;
  }
  for (int peer = 0; peer < on.peer_count; ++peer) {
    if (pieces.counts[peer] > 0) sum += static_cast<std::uint64_t>(pieces.counts[peer]);
  }
  return sum * mpi::BytesOf(1, pieces.type);
}

}  // namespace

Traffic Barrier() { return {0, 0, kNoRoot}; }

Traffic Bcast(const Communicator& on, Piece data, int root) {
  const Role role = RoleIn(on, root);
  const std::uint64_t bytes = role.root || role.member ? BytesOf(data) : 0;
  return {role.root ? PeersOf(on) * bytes : 0, role.member ? bytes : 0, root};
}

Traffic Reduce(const Communicator& on, Piece data, int root) {
  const Role role = RoleIn(on, root);
  const std::uint64_t bytes = role.root || role.member ? BytesOf(data) : 0;
  return {role.member ? bytes : 0, role.root ? PeersOf(on) * bytes : 0, root};
}

Traffic Allreduce(const Communicator& on, Piece data) {
  const std::uint64_t bytes = PeersOf(on) * BytesOf(data);
  return {bytes, bytes, kNoRoot};
}

Traffic Gather(const Communicator& on, Piece send, Piece receive, int root) {
  const Role role = RoleIn(on, root);
  const std::uint64_t piece = role.root ? BytesOf(receive) : 0;
  const std::uint64_t own = !role.member ? 0 : InPlace(send.data) ? piece : BytesOf(send);
  return {own, PeersOf(on) * piece, root};
}

Traffic Gatherv(const Communicator& on, Piece send, Pieces receive, int root) {
  const Role role = RoleIn(on, root);
  std::uint64_t own = 0;
  if (role.member) own = InPlace(send.data) ? BytesOf(receive, on.rank) : BytesOf(send);
  return {own, role.root ? SumOf(on, receive) : 0, root};
}

Traffic Scatter(const Communicator& on, Piece send, Piece receive, int root) {
  const Role role = RoleIn(on, root);
  const std::uint64_t piece = role.root ? BytesOf(send) : 0;
  const std::uint64_t own = !role.member ? 0 : InPlace(receive.data) ? piece : BytesOf(receive);
  return {PeersOf(on) * piece, own, root};
}

Traffic Scatterv(const Communicator& on, Pieces send, Piece receive, int root) {
  const Role role = RoleIn(on, root);
  std::uint64_t own = 0;
  if (role.member) own = InPlace(receive.data) ? BytesOf(send, on.rank) : BytesOf(receive);
  return {role.root ? SumOf(on, send) : 0, own, root};
}

Traffic Allgather(const Communicator& on, Piece send, Piece receive) {
  const std::uint64_t own = InPlace(send.data) ? BytesOf(receive) : BytesOf(send);
  return {PeersOf(on) * own, PeersOf(on) * BytesOf(receive), kNoRoot};
}

Traffic Allgatherv(const Communicator& on, Piece send, Pieces receive) {
  const std::uint64_t own = InPlace(send.data) ? BytesOf(receive, on.rank) : BytesOf(send);
  return {PeersOf(on) * own, SumOf(on, receive), kNoRoot};
}

Traffic Alltoall(const Communicator& on, Piece send, Piece receive) {
  const std::uint64_t piece = BytesOf(receive);
  return {PeersOf(on) * (InPlace(send.data) ? piece : BytesOf(send)), PeersOf(on) * piece, kNoRoot};
}

Traffic Alltoallv(const Communicator& on, Pieces send, Pieces receive) {
  const std::uint64_t received = SumOf(on, receive);
  return {InPlace(send.data) ? received : SumOf(on, send), received, kNoRoot};
}

Traffic ReduceScatter(const Communicator& on, Pieces receive) {
  if (on.between) {  // counts are those of the own group: nothing is known of the other's size
    return {BytesOf(receive, on.rank) * PeersOf(on), BytesOf(receive, on.rank) * PeersOf(on),
            kNoRoot};
  }
  return {SumOf(on, receive), BytesOf(receive, on.rank) * PeersOf(on), kNoRoot};
}

Traffic ReduceScatterBlock(const Communicator& on, Piece receive) {
  const std::uint64_t bytes = PeersOf(on) * BytesOf(receive);
  return {bytes, bytes, kNoRoot};
}

Traffic Scan(const Communicator& on, Piece data) {
  const auto rank = static_cast<std::uint64_t>(on.rank);
  const std::uint64_t bytes = BytesOf(data);
  return {(PeersOf(on) - rank) * bytes, (rank + 1) * bytes, kNoRoot};
}

Traffic Exscan(const Communicator& on, Piece data) {
  const auto rank = static_cast<std::uint64_t>(on.rank);
  const std::uint64_t bytes = BytesOf(data);
  return {(PeersOf(on) - rank - 1) * bytes, rank * bytes, kNoRoot};
}

void RecordCollective(const Visit& visit, const Communicator& on, const Traffic& traffic,
                      uint32_t request) {
  if (on.id == 0) return;  // a handle that MPI will refuse
  int32_t root = -1;
  if (traffic.root == MPI_ROOT) {
    root = on.rank + on.own_offset;
  } else if (traffic.root != MPI_PROC_NULL) {
    root = PeerOf(on, traffic.root);
  }
  Append(MpiCollective{.header = 0,
                       .ticks = visit.EnterTicks(),
                       .bytes_sent = traffic.sent,
                       .bytes_received = traffic.received,
                       .communicator = on.id,
                       .root = root,
                       .region = visit.Region(),
                       .request = request});
}

}  // namespace stipple::mpi
