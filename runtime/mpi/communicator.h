// SPDX-License-Identifier: MIT
// Communicators: their numbers within the process, and what of them the records need.
//
// No message is sent to agree on names. Two ranks know the same communicator by its parent, by how
// many communicators each had created from that parent before, and by its first member: creation is
// collective, so all members count alike. Two kinds need more care:
//  - MPI_Comm_create_group involves only the group, so ranks outside do not count. Its creation
//    number is kCounted with a hash of tag, members and how often this very group was made before.
//  - An intercommunicator has two groups that may share no parent. It is defined as a child of
//    MPI_COMM_WORLD, as the union of its groups, the one with the lower first world rank first, its
//    creation number being such a hash. Peers and roots are recorded as ranks in that union.
// World ranks of processes that were spawned or connected are unknown: -1.
#ifndef STIPPLE_RUNTIME_MPI_COMMUNICATOR_H
#define STIPPLE_RUNTIME_MPI_COMMUNICATOR_H

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdint>

namespace stipple::mpi {

/// Set in creation numbers that are hashes and not counts.
inline constexpr uint32_t kHashedCreation = 0x80000000u;

struct Communicator {
  uint32_t id;          // DefineCommunicator; 0: unknown
  uint32_t creations;   // communicators created from it so far
  int32_t rank;         // of this process; in an intercommunicator, within its own group
  int32_t peer_count;   // ranks that a collective's data goes to: all, or the other group's
  int32_t peer_offset;  // add to a peer's rank for its rank as recorded; 0 in intracommunicators
  int32_t own_offset;   // the same for this process's own group
  bool between;         // an intercommunicator
};

/// Values of mpi.h that are addresses within the MPI library. Looked up, not linked: this library
/// is loaded into programs without MPI too.
struct Predefined {
  MPI_Comm world, self, comm_null;
  MPI_Request request_null, request_empty;  // empty: complete when posted
  MPI_Message message_null, message_no_proc;
  MPI_Datatype byte, datatype_null;
};
extern constinit Predefined predefined;

/// Rank and size in MPI_COMM_WORLD; size 0 before MPI_Init.
struct World {
  int rank;
  int size;
};
extern constinit World world;

/// After MPI_Init: looks up Predefined, fills World, defines MPI_COMM_WORLD (1) and MPI_COMM_SELF
/// (2).
void BeginCommunicators();

/// What is known of `comm`; defined on the spot if it came from nowhere. id 0 if it is null.
Communicator Find(MPI_Comm comm);

/// Whether a message can go to `rank`: not MPI_PROC_NULL, and not a mistake that MPI will report.
inline bool IsPeer(const Communicator& on, int rank) { return rank >= 0 && rank < on.peer_count; }

/// A rank of `comm`'s peers as recorded.
inline int32_t PeerOf(const Communicator& on, int rank) { return rank + on.peer_offset; }

/// `created` (null for ranks outside) came from a call that all of `parent` took part in.
void CommunicatorCreated(MPI_Comm parent, MPI_Comm created);

/// `created` came from MPI_Comm_create_group on `parent` with `tag`.
void CommunicatorCreatedByGroup(MPI_Comm parent, int tag, MPI_Comm created);

/// `created` joins two groups.
void CommunicatorCreatedBetween(MPI_Comm created);

/// A window or file was made by all ranks of `comm`. What they do with it together is counted apart
/// from what they do on `comm`: it is a communicator of its own, as it is within MPI.
void SharedCreated(MPI_Comm comm, const void* handle);

/// That of a window or file; id 0 if it came from nowhere.
Communicator FindShared(const void* handle);

/// Forgets a communicator, window or file and returns what was known of it. Before the call that
/// frees it: afterwards another thread may have been given the same handle.
Communicator Forget(const void* handle);

/// Takes a Forget back: the call failed.
void Remember(const void* handle, const Communicator& known);

}  // namespace stipple::mpi

#endif
