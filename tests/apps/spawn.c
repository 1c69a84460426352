/* SPDX-License-Identifier: MIT */
/* Children that libc starts (posix_spawn, system, popen) and one of clone: what they do is not their
 * parent's. The child of clone has a stream of its own. */
#define _GNU_SOURCE
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

__attribute__((noinline)) void Before(void) { puts("before"); }
__attribute__((noinline)) void Spawn(void) {
  char* arguments[] = {"true", NULL};
  pid_t child;
  int status = 1;
  if (posix_spawn(&child, "/bin/true", NULL, NULL, arguments, environ) == 0)
    waitpid(child, &status, 0);
  printf("spawned %d\n", WEXITSTATUS(status));
}
__attribute__((noinline)) void System(void) { printf("system %d\n", WEXITSTATUS(system("exit 5"))); }
__attribute__((noinline)) void Pipe(void) {
  char line[20] = "";
  FILE* pipe = popen("echo piped", "r");
  if (pipe == NULL || fgets(line, sizeof line, pipe) == NULL) return;
  printf("%s%d\n", line, WEXITSTATUS(pclose(pipe)));
}
__attribute__((noinline)) void InClone(void) { puts("in clone"); }
__attribute__((noinline)) int CloneBody(void* argument) {
  InClone();
  fflush(stdout);
  return argument == NULL ? 6 : 7;
}
__attribute__((noinline)) void Clone(void) {
  enum { kStackBytes = 256 * 1024 };
  char* stack = malloc(kStackBytes);
  int status = 0;
  fflush(stdout);
  const int child = clone(CloneBody, stack + kStackBytes, SIGCHLD, NULL);
  waitpid(child, &status, 0);
  printf("cloned %d\n", WEXITSTATUS(status));
  free(stack);
}

int main(void) {
  Before();
  Spawn();
  System();
  Pipe();
  Clone();
  return 0;
}
