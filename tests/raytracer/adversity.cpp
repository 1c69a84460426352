// SPDX-License-Identifier: MIT
// Bad luck for an MPI program, to be preloaded: it stands before the calls that send, receive or
// look, and is asked for by the environment.
//
//   ADVERSITY_DELAYS=SEED       every such call takes a while at random; who receives from anybody
//   gets
//                               a message of any rank that has sent one; who looks may not see it
//                               yet
//   ADVERSITY_END=RANK:N:HOW    at its Nth call the rank ends: `kill` by SIGKILL, `memory` by
//                               std::bad_alloc; N = 0: when it gives a picture its name
#include <mpi.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>
#include <random>
#include <vector>

namespace {

class BadLuck {
 public:
  BadLuck() {
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    if (const char* seed = std::getenv("ADVERSITY_DELAYS")) {
      delays_ = true;
      random_.seed(std::strtoull(seed, nullptr, 10) * 1000 + static_cast<unsigned>(rank_));
    }
    int rank = -1;
    long at = 0;
    char how[16] = "";
    const char* end = std::getenv("ADVERSITY_END");
    if (end == nullptr) return;
    if (std::sscanf(end, "%d:%ld:%15s", &rank, &at, how) != 3) std::abort();
    if (rank != rank_) return;
    end_at_ = at;
    kill_ = std::strcmp(how, "kill") == 0;
  }

  /// Before each call.
  void Strike() {
    if (++calls_ == end_at_) End();
    if (!delays_) return;
    const std::uint64_t roll = random_() % 512;
    if (roll == 0)
      usleep(20000);
    else if (roll < 16)
      usleep(1000);
    else if (roll < 256)
      usleep(static_cast<useconds_t>(random_() % 200));
  }

  void StrikeAtPicture() {
    if (end_at_ == 0) End();
  }

  bool delays() const { return delays_; }
  bool Overlooks() { return delays_ && random_() % 4 == 0; }

  /// Of any rank that has sent something; false if none has.
  bool FindSender(int tag, MPI_Comm comm, MPI_Status* status) {
    int size = 0;
    PMPI_Comm_size(comm, &size);
    std::vector<int> ranks(static_cast<std::size_t>(size));
    std::iota(ranks.begin(), ranks.end(), 0);
    std::shuffle(ranks.begin(), ranks.end(), random_);
    for (const int rank : ranks) {
      int there = 0;
      PMPI_Iprobe(rank, tag, comm, &there, status);
      if (there != 0) return true;
    }
    return false;
  }

 private:
  void End() {
    if (kill_) raise(SIGKILL);
    throw std::bad_alloc();
  }

  int rank_ = 0;
  bool delays_ = false, kill_ = false;
  long calls_ = 0, end_at_ = -1;
  std::mt19937_64 random_;
};

BadLuck& Luck() {
  static BadLuck luck;
  return luck;
}

/// Where the call is to look instead of anywhere, once something is there.
int AwaitSender(int source, int tag, MPI_Comm comm) {
  if (source != MPI_ANY_SOURCE || !Luck().delays()) return source;
  MPI_Status status;
  while (!Luck().FindSender(tag, comm, &status)) usleep(50);
  return status.MPI_SOURCE;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int rename(const char* from, const char* to) noexcept {
  int running = 0;
  PMPI_Initialized(&running);
  if (running != 0 && std::strstr(to, ".png") != nullptr) Luck().StrikeAtPicture();
  return static_cast<int>(syscall(SYS_rename, from, to));
}

int MPI_Send(const void* buffer, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm) {
  Luck().Strike();
  return PMPI_Send(buffer, count, type, to, tag, comm);
}

int MPI_Isend(const void* buffer, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
              MPI_Request* request) {
  Luck().Strike();
  return PMPI_Isend(buffer, count, type, to, tag, comm, request);
}

int MPI_Recv(void* buffer, int count, MPI_Datatype type, int source, int tag, MPI_Comm comm,
             MPI_Status* status) {
  Luck().Strike();
  return PMPI_Recv(buffer, count, type, AwaitSender(source, tag, comm), tag, comm, status);
}

int MPI_Probe(int source, int tag, MPI_Comm comm, MPI_Status* status) {
  Luck().Strike();
  return PMPI_Probe(AwaitSender(source, tag, comm), tag, comm, status);
}

int MPI_Iprobe(int source, int tag, MPI_Comm comm, int* there, MPI_Status* status) {
  Luck().Strike();
  *there = 0;
  if (Luck().Overlooks()) return MPI_SUCCESS;
  if (source != MPI_ANY_SOURCE || !Luck().delays())
    return PMPI_Iprobe(source, tag, comm, there, status);
  *there = Luck().FindSender(tag, comm, status) ? 1 : 0;
  return MPI_SUCCESS;
}

int MPI_Test(MPI_Request* request, int* done, MPI_Status* status) {
  Luck().Strike();
  return PMPI_Test(request, done, status);
}

int MPI_Fetch_and_op(const void* origin, void* result, MPI_Datatype type, int rank, MPI_Aint place,
                     MPI_Op op, MPI_Win window) {
  Luck().Strike();
  return PMPI_Fetch_and_op(origin, result, type, rank, place, op, window);
}

int MPI_Allreduce(const void* send, void* receive, int count, MPI_Datatype type, MPI_Op op,
                  MPI_Comm comm) {
  Luck().Strike();
  return PMPI_Allreduce(send, receive, count, type, op, comm);
}
}
