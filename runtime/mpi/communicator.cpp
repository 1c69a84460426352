// SPDX-License-Identifier: MIT
#include "runtime/mpi/communicator.h"

#include "runtime/mpi/call.h"
#include "runtime/mpi/handle_table.h"
#include "stipple/format.h"

namespace stipple::mpi {

constinit Predefined predefined = {};
constinit World world = {};
constinit bool threads_may_race = false;

namespace {

constexpr uint32_t kWorldId = 1;
constexpr uint32_t kSelfId = 2;

constinit HandleTable<Communicator> communicators;  // by their handles, and windows' and files'
constinit HandleTable<uint32_t> hashed_creations;   // how often a hash has been seen
constinit std::atomic<uint32_t> last_id{kSelfId};
MPI_Group world_group;  // for translating; MPI_Finalize frees it with everything else

std::uint64_t KeyOf(const void* handle) { return reinterpret_cast<std::uint64_t>(handle); }

std::uint64_t Mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}

/// Creation number of a group with this hash that `parent` may have been asked for before. The
/// parent's number is this process's own, so it counts but is no part of the result.
uint32_t HashedCreation(std::uint64_t hash, uint32_t parent) {
  const std::uint64_t key = Mix(hash, parent) | 1;  // keys are never 0
  uint32_t before = 0;
  if (!hashed_creations.Update(key, [&](uint32_t& seen) { before = seen++; })) {
    hashed_creations.Put(key, 1);
  }
  return kHashedCreation | static_cast<uint32_t>(Mix(hash, before) >> 33);
}

/// World ranks of `group`'s members, written to `members`.
void Translate(MPI_Group group, int size, int32_t* members) {
  Scratch<int, 256> own(static_cast<std::size_t>(size));
  if (own.Data() == nullptr) return;
  for (int i = 0; i < size; ++i) own[static_cast<std::size_t>(i)] = i;
  STIPPLE_REAL(Group_translate_ranks)(group, size, own.Data(), world_group, members);
  for (int i = 0; i < size; ++i) {
    if (members[i] == MPI_UNDEFINED) members[i] = -1;
  }
}

/// Both groups of a communicator, the remote one empty in an intracommunicator.
struct Groups {
  MPI_Group local, remote;
  int local_size, remote_size;
};

Groups GroupsOf(MPI_Comm comm, bool between) {
  Groups groups = {};
  STIPPLE_REAL(Comm_group)(comm, &groups.local);
  STIPPLE_REAL(Group_size)(groups.local, &groups.local_size);
  if (between) {
    STIPPLE_REAL(Comm_remote_group)(comm, &groups.remote);
    STIPPLE_REAL(Group_size)(groups.remote, &groups.remote_size);
  }
  return groups;
}

void FreeGroups(Groups groups) {
  STIPPLE_REAL(Group_free)(&groups.local);
  if (groups.remote_size != 0) STIPPLE_REAL(Group_free)(&groups.remote);
}

bool IsBetween(MPI_Comm comm) {
  int between = 0;
  STIPPLE_REAL(Comm_test_inter)(comm, &between);
  return between != 0;
}

/// Where a new communicator comes from.
struct Origin {
  uint32_t parent;
  uint32_t creation;  // a count, unless `hashed`
  bool hashed;        // by members and `tag`
  int tag;
};

void Write(uint32_t id, const Origin& origin, const int32_t* members, int size) {
  uint32_t creation = origin.creation;
  if (origin.hashed) {
    std::uint64_t hash = Mix(0x5717, static_cast<std::uint64_t>(origin.tag));
    for (int i = 0; i < size; ++i) hash = Mix(hash, static_cast<std::uint64_t>(members[i]));
    creation = HashedCreation(hash, origin.parent);
  }
  const DefineCommunicator definition = {
      .header = 0, .communicator = id, .parent = origin.parent, .creation = creation, .size = size};
  stipple_define(&definition, static_cast<uint8_t>(DefineCommunicator::kKind), sizeof definition,
                 members, static_cast<std::size_t>(size) * sizeof(int32_t));
}

/// Defines the ranks of `comm` under `id` and remembers them as those of `handle`.
Communicator Define(MPI_Comm comm, uint32_t id, Origin origin, const void* handle) {
  const bool between = IsBetween(comm);
  const Groups groups = GroupsOf(comm, between);
  Communicator known = {.id = id,
                        .creations = 0,
                        .rank = 0,
                        .peer_count = between ? groups.remote_size : groups.local_size,
                        .peer_offset = 0,
                        .own_offset = 0,
                        .between = between};
  STIPPLE_REAL(Comm_rank)(comm, &known.rank);
  const int size = groups.local_size + groups.remote_size;
  Scratch<int32_t, 256> members(static_cast<std::size_t>(size));
  if (members.Data() != nullptr) {
    Translate(groups.local, groups.local_size, members.Data());
    if (between) {
      int32_t remote_first = -1;
      const int first = 0;
      STIPPLE_REAL(Group_translate_ranks)(groups.remote, 1, &first, world_group, &remote_first);
      const bool local_first = members[0] >= 0 && (remote_first < 0 || members[0] < remote_first);
      known.own_offset = local_first ? 0 : groups.remote_size;
      known.peer_offset = local_first ? groups.local_size : 0;
      Translate(groups.local, groups.local_size, members.Data() + known.own_offset);
      Translate(groups.remote, groups.remote_size, members.Data() + known.peer_offset);
      origin = {.parent = kWorldId, .creation = 0, .hashed = true, .tag = 0};
    }
    Write(id, origin, members.Data(), size);
  }
  FreeGroups(groups);
  communicators.Put(KeyOf(handle), known);
  return known;
}
Communicator Define(MPI_Comm comm, uint32_t id, Origin origin) {
  return Define(comm, id, origin, comm);
}

uint32_t NextId() { return last_id.fetch_add(1, std::memory_order_relaxed) + 1; }

bool IsNull(MPI_Comm comm) { return comm == nullptr || comm == predefined.comm_null; }

/// Something is created from `parent` by all of its ranks.
Origin CountCreation(MPI_Comm parent) {
  const Communicator from = Find(parent);
  communicators.Update(KeyOf(parent), [](Communicator& known) { ++known.creations; });
  return {.parent = from.id, .creation = from.creations, .hashed = false, .tag = 0};
}

/// By the names that they have in MPI.
#ifdef STIPPLE_CLASSIC_PMPI
void FindPredefined() {
  predefined = {.world = MPI_COMM_WORLD,
                .self = MPI_COMM_SELF,
                .comm_null = MPI_COMM_NULL,
                .request_null = MPI_REQUEST_NULL,
                .request_empty = MPI_REQUEST_NULL,
                .message_null = MPI_MESSAGE_NULL,
                .message_no_proc = MPI_MESSAGE_NULL,
                .byte = MPI_BYTE,
                .datatype_null = MPI_DATATYPE_NULL};
}
#else
void FindPredefined() {
  predefined.world = static_cast<MPI_Comm>(FindVariable("ompi_mpi_comm_world"));
  predefined.self = static_cast<MPI_Comm>(FindVariable("ompi_mpi_comm_self"));
  predefined.comm_null = static_cast<MPI_Comm>(FindVariable("ompi_mpi_comm_null"));
  predefined.request_null = static_cast<MPI_Request>(FindVariable("ompi_request_null"));
  predefined.request_empty = static_cast<MPI_Request>(FindVariable("ompi_request_empty"));
  predefined.message_null = static_cast<MPI_Message>(FindVariable("ompi_message_null"));
  predefined.message_no_proc = static_cast<MPI_Message>(FindVariable("ompi_message_no_proc"));
  predefined.byte = static_cast<MPI_Datatype>(FindVariable("ompi_mpi_byte"));
  predefined.datatype_null = static_cast<MPI_Datatype>(FindVariable("ompi_mpi_datatype_null"));
}
#endif

}  // namespace

void BeginCommunicators() {
  FindPredefined();
  STIPPLE_REAL(Comm_rank)(predefined.world, &world.rank);
  STIPPLE_REAL(Comm_size)(predefined.world, &world.size);
  STIPPLE_REAL(Comm_group)(predefined.world, &world_group);
  const DefineWorld definition = {.header = 0, .world_rank = world.rank, .world_size = world.size};
  stipple_define(&definition, static_cast<uint8_t>(DefineWorld::kKind), sizeof definition, nullptr,
                 0);
  Define(predefined.world, kWorldId, {.parent = 0, .creation = 0, .hashed = false, .tag = 0});
  Define(predefined.self, kSelfId, {.parent = 0, .creation = 1, .hashed = false, .tag = 0});
}

Communicator Find(MPI_Comm comm) {
  Communicator known = {};
  if (world.size == 0 || IsNull(comm)) return known;
  if (communicators.Get(KeyOf(comm), &known)) return known;
  // Created where this layer does not look: inside a callback, or by a call of a newer MPI.
  return Define(comm, NextId(), {.parent = kWorldId, .creation = 0, .hashed = true, .tag = 0});
}

void CommunicatorCreated(MPI_Comm parent, MPI_Comm created) {
  const Origin origin = CountCreation(parent);
  if (!IsNull(created)) Define(created, NextId(), origin);
}

void SharedCreated(MPI_Comm comm, const void* handle) {
  if (world.size == 0 || handle == nullptr) return;
  Define(comm, NextId(), CountCreation(comm), handle);
}

Communicator FindShared(const void* handle) {
  Communicator known = {};
  communicators.Get(KeyOf(handle), &known);
  return known;
}

void CommunicatorCreatedByGroup(MPI_Comm parent, int tag, MPI_Comm created) {
  if (IsNull(created)) return;
  const Communicator from = Find(parent);
  Define(created, NextId(), {.parent = from.id, .creation = 0, .hashed = true, .tag = tag});
}

void CommunicatorCreatedBetween(MPI_Comm created) {
  if (IsNull(created) || world.size == 0) return;
  Communicator known;
  if (communicators.Get(KeyOf(created), &known)) return;  // MPI_Comm_get_parent, once more
  Define(created, NextId(), {.parent = kWorldId, .creation = 0, .hashed = true, .tag = 0});
}

Communicator Forget(const void* handle) {
  const Communicator known = FindShared(handle);
  communicators.RemoveIf(KeyOf(handle), [](const Communicator&) { return true; });
  return known;
}

void Remember(const void* handle, const Communicator& known) {
  if (known.id != 0) communicators.Put(KeyOf(handle), known);
}

}  // namespace stipple::mpi
