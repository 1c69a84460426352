// SPDX-License-Identifier: MIT
// How long the steps of a run took.
#ifndef STIPPLE_RAYTRACER_STOPWATCH_H
#define STIPPLE_RAYTRACER_STOPWATCH_H

#include <mpi.h>
#include <time.h>

#include <utility>

namespace stipple::raytracer {

/// Seconds since it was made or last asked: of the clock on the wall, and of CPU time of the
/// process.
class Stopwatch {
 public:
  double Lap() {
    const double now = MPI_Wtime();
    return now - std::exchange(start_, now);
  }
  double LapCpu() {
    const double now = CpuSeconds();
    return now - std::exchange(cpu_start_, now);
  }

 private:
  static double CpuSeconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double start_ = MPI_Wtime();
  double cpu_start_ = CpuSeconds();
};

}  // namespace stipple::raytracer

#endif
