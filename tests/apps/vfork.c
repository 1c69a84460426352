/* SPDX-License-Identifier: MIT */
/* A child of vfork runs on its parent's stack and in its stream: what it entered is left when the
 * parent goes on. One ends by exec, one by _exit after an exec that failed, one from deep inside. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

__attribute__((noinline)) void Execute(const char* path) { execl(path, path, (char*)NULL); }
__attribute__((noinline)) int Deep(int depth) {
  if (depth == 0) _exit(3);
  volatile int here = depth; /* no tail call */
  return Deep(depth - 1) + here;
}
__attribute__((noinline)) void Child(int how) {
  if (how == 0) Execute("/bin/true");
  if (how == 1) Execute("/nonexistent/program");
  if (how == 2) Deep(2);
  _exit(4);
}
__attribute__((noinline)) void Parent(int status) { printf("status %d\n", WEXITSTATUS(status)); }
__attribute__((noinline)) void Start(int how) {
  int status = 0;
  const pid_t child = vfork();
  if (child == 0) Child(how);
  waitpid(child, &status, 0);
  Parent(status);
}

int main(void) {
  for (int how = 0; how < 3; ++how) Start(how);
  return 0;
}
