/* SPDX-License-Identifier: MIT */
/* Ends by a signal, in the way that is asked for, or recovers from one. */
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

static volatile int* nowhere;
static pthread_barrier_t ready;
static sigjmp_buf back;

/* The asm keeps calls from becoming jumps: the caller is to stand on the stack. */
__attribute__((noinline)) int Poke(int n) {
  const int value = *nowhere;
  __asm__ volatile("");
  return value + n;
}

__attribute__((noinline)) int Outer(int n) {
  const int value = Poke(n) + 1;
  __asm__ volatile("");
  return value;
}

__attribute__((noinline)) int Deep(int n) {
  volatile char frame[200];
  frame[0] = (char)n;
  const int value = n >= 0 ? Deep(n + 1) + frame[0] : 0;
  __asm__ volatile("");
  return value;
}

__attribute__((noinline)) void Idle(void) {
  pthread_barrier_wait(&ready);
  for (;;) pause();
}

static void* IdleThread(void* argument) {
  Idle();
  return argument;
}

static void* PokeThread(void* argument) {
  pthread_barrier_wait(&ready);
  Outer(1);
  return argument;
}

static void* DeepThread(void* argument) {
  Deep(0);
  return argument;
}

static void RunThread(void* (*function)(void*)) {
  pthread_t thread;
  pthread_create(&thread, NULL, function, NULL);
  pthread_join(thread, NULL);
}

static void CrashWhileOthersRun(void) {
  pthread_t threads[2];
  pthread_barrier_init(&ready, NULL, 3);
  for (int i = 0; i < 2; ++i) pthread_create(&threads[i], NULL, IdleThread, NULL);
  RunThread(PokeThread);
}

static void JumpBack(int number) {
  (void)number;
  siglongjmp(back, 1);
}

static void PokeAgain(int number) { *nowhere = number; }

static void GoBackToDefault(int number) {
  signal(number, SIG_DFL);
  raise(number);
}

/* What the program asks about its handlers must be what it would be without a runtime. */
static int Recover(void) {
  struct sigaction action;
  struct sigaction before;
  volatile int times = 0;
  memset(&action, 0, sizeof action);
  action.sa_handler = JumpBack;
  if (sigaction(SIGSEGV, &action, &before) != 0 || before.sa_handler != SIG_DFL) return 3;
  while (times < 1000) {
    if (sigsetjmp(back, 1) == 0) Outer(times);
    ++times;
  }
  if (signal(SIGSEGV, SIG_DFL) != JumpBack || signal(SIGSEGV, SIG_IGN) != SIG_DFL) return 4;
  printf("recovered %d times\n", times);
  return 0;
}

static int CrashOfChild(void) {
  int status = 0;
  const pid_t child = fork();
  if (child == 0) _exit(Outer(1));
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 1;
}

int main(int count, char** words) {
  const char* how = count > 1 ? words[1] : "";
  if (strcmp(how, "null") == 0) return Outer(1);
  if (strcmp(how, "thread") == 0) CrashWhileOthersRun();
  if (strcmp(how, "overflow") == 0) return Deep(0);
  if (strcmp(how, "overflow-thread") == 0) RunThread(DeepThread);
  if (strcmp(how, "abort") == 0) abort();
  if (strcmp(how, "trap") == 0) __builtin_trap();
  if (strcmp(how, "breakpoint") == 0) __asm__ volatile("int3");
  if (strcmp(how, "kill") == 0) kill(getpid(), SIGSEGV);
  if (strcmp(how, "double") == 0) signal(SIGSEGV, PokeAgain), Outer(1);
  if (strcmp(how, "default") == 0) signal(SIGSEGV, GoBackToDefault), Outer(1);
  if (strcmp(how, "recover") == 0) return Recover();
  if (strcmp(how, "child") == 0) return CrashOfChild();
  return 2;
}
