// SPDX-License-Identifier: MIT
// What system events are recorded of: one behaviour each, by its name. Prints what a program sees
// of it, which must be the same recorded or not.
#define _GNU_SOURCE
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "stipple/user.h"

static struct stipple_name begin_mark = {"begin", "", 0};
static struct stipple_name child_mark = {"child", "", 0};
static struct stipple_name end_mark = {"end", "", 0};

static void Nap(void) {
  const struct timespec time = {0, 20 * 1000 * 1000};
  nanosleep(&time, NULL);
}

static void Sleep(void) {
  for (int i = 0; i < 3; ++i) Nap();
}

static pthread_barrier_t barrier;

/// Until it has had 50 ms of the processor that it shares with another.
static void* Spin(void* argument) {
  struct timespec used;
  pthread_barrier_wait(&barrier);
  do clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  while (used.tv_sec == 0 && used.tv_nsec < 50 * 1000 * 1000);
  return argument;
}

static void Preempted(void) {
  cpu_set_t all;
  sched_getaffinity(0, sizeof all, &all);
  int processor = 0;
  while (!CPU_ISSET(processor, &all)) ++processor;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(processor, &one);
  sched_setaffinity(0, sizeof one, &one);
  pthread_t threads[2];
  pthread_barrier_init(&barrier, NULL, 2);
  for (int i = 0; i < 2; ++i) pthread_create(&threads[i], NULL, Spin, NULL);
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
}

static void Pipe(void) {
  int ends[2];
  char bytes[16];
  if (pipe(ends) != 0) abort();
  printf("write %zd\n", write(ends[1], "hello", 5));
  printf("read %zd\n", read(ends[0], bytes, sizeof bytes));
  errno = 0;
  const ssize_t result = read(-1, bytes, 1);
  printf("read %zd %s\n", result, strerror(errno));
  errno = ENOTTY;
  printf("close %d %d", close(ends[0]), close(ends[1]));
  printf(" %s\n", strerror(errno));
}

static void OnAlarm(int signal) { (void)signal; }

static void Interrupted(void) {
  int ends[2];
  char byte;
  struct sigaction action = {0};
  action.sa_handler = OnAlarm;
  sigaction(SIGALRM, &action, NULL);
  if (pipe(ends) != 0) abort();
  ualarm(20000, 0);
  errno = 0;
  const ssize_t result = read(ends[0], &byte, 1);
  printf("read %zd %s\n", result, strerror(errno));
  ualarm(20000, 0);
  errno = 0;
  const long raw = syscall(SYS_read, ends[0], &byte, 1);
  printf("raw read %ld %s\n", raw, strerror(errno));
}

static void NoteEnd(void* argument) { puts(argument); }

static void* Read(void* argument) {
  char byte;
  pthread_cleanup_push(NoteEnd, "cleaned up");
  pthread_barrier_wait(&barrier);
  if (read(*(int*)argument, &byte, 1) == 1) puts("read");
  pthread_cleanup_pop(0);
  return NULL;
}

static void Cancelled(void) {
  int ends[2];
  if (pipe(ends) != 0) abort();
  pthread_t thread;
  void* result = NULL;
  pthread_barrier_init(&barrier, NULL, 2);
  pthread_create(&thread, NULL, Read, &ends[0]);
  pthread_barrier_wait(&barrier);
  Nap();
  pthread_cancel(thread);
  pthread_join(thread, &result);
  puts(result == PTHREAD_CANCELED ? "cancelled" : "returned");
}

static void Forked(void) {
  fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    stipple_mark(&child_mark);
    Nap();
    _exit(3);
  }
  int status = 0;
  waitpid(child, &status, 0);
  printf("child %d\n", WEXITSTATUS(status));
}

static void* Short(void* argument) {
  Nap();
  return argument;
}

static void Threads(void) {
  pthread_t threads[100];
  for (int i = 0; i < 100; ++i)
    if (pthread_create(&threads[i], NULL, Short, NULL) != 0) abort();
  for (int i = 0; i < 100; ++i) pthread_join(threads[i], NULL);
}

static volatile sig_atomic_t handled;

static void OnUser(int signal) {
  (void)signal;
  if (syscall(SYS_getppid) > 0) handled = handled + 1;
}

static void Raw(void) {
  for (int i = 0; i < 7; ++i)
    if (syscall(SYS_getppid) <= 0) abort();
  struct sigaction action = {0};
  action.sa_handler = OnUser;
  sigfillset(&action.sa_mask);
  sigaction(SIGUSR1, &action, NULL);
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, NULL);
  raise(SIGUSR1);
  printf("blocked %d\n", (int)handled);
  sigemptyset(&all);
  pthread_sigmask(SIG_SETMASK, &all, NULL);
  printf("handled %d\n", (int)handled);
  fflush(stdout);
  const pid_t child = vfork();
  if (child == 0) {
    execlp("true", "true", (char*)NULL);
    _exit(9);
  }
  int status = 0;
  waitpid(child, &status, 0);
  printf("child %d\n", WEXITSTATUS(status));
  printf("shell %d\n", WEXITSTATUS(system("exit 5")));
}

/// The program wants SIGSYS for itself.
static void Own(void) {
  struct sigaction action = {0};
  action.sa_handler = OnUser;
  if (syscall(SYS_getppid) <= 0) abort();
  sigaction(SIGSYS, &action, NULL);
  raise(SIGSYS);
  printf("handled %d\n", (int)handled);
}

int main(int count, char** words) {
  static const struct {
    const char* name;
    void (*run)(void);
  } kRows[] = {{"sleep", Sleep},
               {"preempted", Preempted},
               {"pipe", Pipe},
               {"interrupted", Interrupted},
               {"cancelled", Cancelled},
               {"forked", Forked},
               {"threads", Threads},
               {"raw", Raw},
               {"own", Own}};
  stipple_mark(&begin_mark);
  for (size_t i = 0; count > 1 && i < sizeof kRows / sizeof kRows[0]; ++i)
    if (strcmp(words[1], kRows[i].name) == 0) kRows[i].run();
  stipple_mark(&end_mark);
  return 0;
}
