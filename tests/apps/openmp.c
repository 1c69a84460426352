/* SPDX-License-Identifier: MIT */
/* Threads of OpenMP are locations; tasks are visits of the thread that ran them. */
#include <omp.h>
#include <stdio.h>

__attribute__((noinline)) void Shared(int thread) { __asm__ volatile("" : : "r"(thread)); }
__attribute__((noinline)) void Task(int number) { __asm__ volatile("" : : "r"(number)); }

int main(void) {
#pragma omp parallel num_threads(2)
  Shared(omp_get_thread_num());
#pragma omp parallel num_threads(1)
  {
#pragma omp task
    Task(1);
#pragma omp task if (0)
    Task(2);
#pragma omp taskwait
  }
  puts("done");
  return 0;
}
