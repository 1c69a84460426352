/* SPDX-License-Identifier: MIT */
/* The main thread ends by pthread_exit; another one goes on and ends the process. */
#include <pthread.h>
#include <stdio.h>

static pthread_t main_thread;

__attribute__((noinline)) void Note(const char* what) { puts(what); }
__attribute__((noinline)) void End(void) {
  Note("main ends");
  pthread_exit(NULL);
}
void* Other(void* argument) {
  pthread_join(main_thread, NULL);
  Note("other goes on");
  return argument;
}

int main(void) {
  pthread_t thread;
  main_thread = pthread_self();
  pthread_create(&thread, NULL, Other, NULL);
  pthread_detach(thread);
  End();
  return 1;
}
