// SPDX-License-Identifier: MIT
// The traced program of the adversity tests: `adversity_writer BEHAVIOUR NUMBER [FILE]`. Visit n of
// a thread enters ones[n mod 61] and, inside, twos[n mod 59], so that a lost or doubled piece of
// its events shows.
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <setjmp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "adversity.h"
#include "stipple/format.h"

namespace {

using stipple_test::Enter;
using stipple_test::kOnes;
using stipple_test::kTwos;
using stipple_test::Leave;
using stipple_test::Progress;
using stipple_test::Regions;

constexpr int kStatus = 3;
const Regions* regions = nullptr;
const char* file_name = nullptr;

void Visit(long n) {
  const std::uint32_t one = Enter(regions->dso, regions->descriptors[n % kOnes]);
  const std::uint32_t two = Enter(regions->dso, regions->descriptors[kOnes + n % kTwos]);
  Leave(regions->dso, two);
  Leave(regions->dso, one);
}

thread_local long next_visit = 0;

void Visits(long count) {
  for (long end = next_visit + count; next_visit < end; ++next_visit) Visit(next_visit);
}

int Return(long count) {
  Visits(count);
  return kStatus;
}

Progress* MapProgress() {
  const int descriptor = open(file_name, O_RDWR | O_CREAT, 0600);
  if (ftruncate(descriptor, 4096) != 0) _exit(1);
  void* memory = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  close(descriptor);
  return static_cast<Progress*>(memory);
}

void VisitForever(Progress* progress) {
  progress->tid = syscall(SYS_gettid);
  for (long n = 0;; ++n) {
    Visit(n);
    progress->visits.store(n + 1, std::memory_order_release);
  }
}

/// Four threads, until somebody kills the process.
int KilledThreads(long) {
  Progress* progress = MapProgress();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(VisitForever, progress + i);
  for (std::thread& thread : threads) thread.join();
  return 0;
}

/// Four processes, until somebody kills the group.
int KilledProcesses(long) {
  Progress* progress = MapProgress();
  for (int i = 0; i < 4; ++i)
    if (fork() == 0) VisitForever(progress + i);
  while (wait(nullptr) > 0) {
  }
  return 0;
}

struct Crowd {
  pthread_barrier_t all_begun;
  long visits;
};

/// So many threads at once, a hundred events each.
int ManyThreads(long count) {
  Crowd crowd{{}, 25};
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, 64 * 1024);
  pthread_barrier_init(&crowd.all_begun, nullptr, static_cast<unsigned>(count));
  const auto body = [](void* pointer) -> void* {
    auto* c = static_cast<Crowd*>(pointer);
    Visit(0);
    pthread_barrier_wait(&c->all_begun);
    for (long n = 1; n < c->visits; ++n) Visit(n);
    return nullptr;
  };
  std::vector<pthread_t> threads(static_cast<std::size_t>(count));
  for (pthread_t& thread : threads)
    if (pthread_create(&thread, &attributes, body, &crowd) != 0) _exit(77);
  for (const pthread_t& thread : threads) pthread_join(thread, nullptr);
  return kStatus;
}

/// One thread after the other.
int ThreadByThread(long count) {
  for (long i = 0; i < count; ++i) std::thread(Visits, 1000).join();
  return kStatus;
}

/// A thread that is silent while another records much, inside a visit.
int Silent(long count) {
  const std::uint32_t token = Enter(regions->dso, regions->descriptors[0]);
  std::thread(Visits, count).join();
  Leave(regions->dso, token);
  return kStatus;
}

void Deep(long depth, long visits) {
  const std::uint32_t token = Enter(regions->dso, regions->descriptors[depth % kOnes]);
  if (depth > 0)
    Deep(depth - 1, visits);
  else
    Visits(visits);
  Leave(regions->dso, token);
}

/// Many visits below `depth` open ones.
int Nested(long depth) {
  Deep(depth - 1, 2'000'000);
  return kStatus;
}

jmp_buf back;

[[gnu::noinline]] void DiveAndJump(long count) {
  Enter(regions->dso, regions->descriptors[1]);
  Enter(regions->dso, regions->descriptors[2]);
  Visits(count);
  longjmp(back, 1);
}

[[gnu::noinline]] void ComeBackFiveTimes(long count) {
  static long jumps = 0;
  setjmp(back);
  if (++jumps <= 5) DiveAndJump(count);
  Visits(count);
}

/// Jumps from deep down to a frame entered long before, again and again.
int Jumps(long count) {
  const std::uint32_t token = Enter(regions->dso, regions->descriptors[0]);
  ComeBackFiveTimes(count);
  Leave(regions->dso, token);
  return kStatus;
}

/// From now on a system call fails: what a disk without quota left or a broken one answers.
void FailFromNowOn(unsigned call, unsigned error) {
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | error),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter{4, program};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0)
    _exit(77);
}

int Quota(long count) {
  Visits(1000);
  FailFromNowOn(SYS_fallocate, EDQUOT);
  Visits(count);
  return kStatus;
}

int BrokenDisk(long count) {
  Visits(1000);
  FailFromNowOn(SYS_pwrite64, EIO);
  Visits(count);
  return kStatus;
}

/// The archive is deleted under the program.
int Deleted(long count) {
  Visits(1000);
  std::filesystem::remove_all(getenv("STIPPLE_ARCHIVE"));
  Visits(count);
  return kStatus;
}

/// A daemon: no descriptors but three, few allowed, another directory.
int Daemon(long count) {
  Visits(1000);
  closefrom(3);
  const rlimit few{3, 3};
  if (setrlimit(RLIMIT_NOFILE, &few) != 0 || chdir("/") != 0) _exit(77);
  Visits(count);
  return kStatus;
}

int Jailed(long count) {
  Visits(1000);
  closefrom(3);
  if (chroot("/proc") != 0 || chdir("/") != 0) _exit(77);
  Visits(count);
  return kStatus;
}

/// Adds to a word of the file.
void AddAt(int file, off_t offset, std::uint64_t more) {
  std::uint64_t word = 0;
  if (pread(file, &word, sizeof word, offset) != sizeof word) _exit(1);
  word += more;
  if (pwrite(file, &word, sizeof word, offset) != sizeof word) _exit(1);
}

/// The clock steps back: what the stream knows of it so far was later by that much. The low 40 bits
/// of the events stay.
int ClockBack(long count) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 41;
  Visits(count);
  const std::filesystem::directory_iterator archive(getenv("STIPPLE_ARCHIVE"));
  const int file = open(archive->path().c_str(), O_RDWR);
  AddAt(file, offsetof(stipple::FileHeader, start_ticks), kStep);
  stipple::ChunkHeader header;
  for (off_t at = stipple::kGranuleBytes; pread(file, &header, sizeof header, at) > 0;
       at += stipple::kGranuleBytes)
    if (header.magic == stipple::kChunkMagic)
      AddAt(file, at + static_cast<off_t>(offsetof(stipple::ChunkHeader, ticks)), kStep);
  close(file);
  Visits(count);
  return kStatus;
}

struct Behaviour {
  std::string_view name;
  int (*run)(long number);
};
constexpr Behaviour kBehaviours[] = {
    {"return", Return},
    {"killed-threads", KilledThreads},
    {"killed-processes", KilledProcesses},
    {"many-threads", ManyThreads},
    {"thread-by-thread", ThreadByThread},
    {"silent", Silent},
    {"nested", Nested},
    {"jumps", Jumps},
    {"quota", Quota},
    {"broken-disk", BrokenDisk},
    {"deleted", Deleted},
    {"daemon", Daemon},
    {"jailed", Jailed},
    {"clock-back", ClockBack},
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  if (argc > 3) file_name = argv[3];
  static const Regions of_main;
  regions = &of_main;
  for (const Behaviour& behaviour : kBehaviours)
    if (behaviour.name == argv[1]) {
      const int status = behaviour.run(std::atol(argv[2]));
      std::printf("done\n");
      return status;
    }
  return 2;
}
