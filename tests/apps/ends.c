/* SPDX-License-Identifier: MIT */
/* The program ends inside nested calls, the way its argument says: exit, _exit or abort. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

__attribute__((noinline)) void AtExit(void) { puts("at exit"); }
__attribute__((noinline)) void End(const char* how) {
  puts(how);
  fflush(stdout);
  if (strcmp(how, "exit") == 0) exit(0);
  if (strcmp(how, "_exit") == 0) _exit(0);
  abort();
}
__attribute__((noinline)) void Inner(const char* how) {
  End(how);
  puts("never");
}

int main(int argc, char** argv) {
  atexit(AtExit);
  Inner(argc > 1 ? argv[1] : "exit");
  return 0;
}
