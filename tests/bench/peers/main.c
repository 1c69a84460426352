/* SPDX-License-Identifier: MIT */
/* Runs a kernel of ../events and prints the thread's CPU time, ns per call: the program of `./run
 * bench peers`, the same for each tracer. Itself it is never traced. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

uint64_t kernel_run(uint64_t calls);

/* XRay's flight data recorder begins, and writes its log, when it is told to. */
int __xray_log_init_mode(const char* mode, const char* options) __attribute__((weak));
int __xray_log_finalize(void) __attribute__((weak));
int __xray_log_flushLog(void) __attribute__((weak));

static double CpuNs(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

int main(int argc, char** argv) {
  const uint64_t calls = argc > 1 ? strtoull(argv[1], NULL, 10) : 600000;
  const char* options = getenv("XRAY_FDR_OPTIONS");
  if (__xray_log_init_mode != NULL && options != NULL) __xray_log_init_mode("xray-fdr", options);
  const double start = CpuNs();
  const uint64_t sum = kernel_run(calls);
  const double span = CpuNs() - start;
  if (__xray_log_finalize != NULL && __xray_log_flushLog != NULL) {
    __xray_log_finalize();
    __xray_log_flushLog();
  }
  fprintf(stderr, "ns per call: %.3f\n", span / (double)calls);
  return sum == 1;
}
