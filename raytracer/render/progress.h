// SPDX-License-Identifier: MIT
// How far the picture is and how long it takes, on standard error: one line rewritten on a
// terminal, from half a second on; elsewhere a few lines, after 2, 4, 8, ... seconds.
//
// One rank tells: the host of all bundles, else rank 0 of its own share, which is like the others'.
// So nobody sends a message for it.
#ifndef STIPPLE_RAYTRACER_RENDER_PROGRESS_H
#define STIPPLE_RAYTRACER_RENDER_PROGRESS_H

#include <cstddef>
#include <string>

namespace stipple::raytracer {

/// What is shown when `done` of `total` points took `seconds`.
std::string ProgressText(std::size_t done, std::size_t total, double seconds);

class Progress {
 public:
  /// Says nothing if it is not `shown`.
  Progress(std::size_t total, bool shown);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Advance(std::size_t points) {
    done_ += points;
    if (done_ >= next_look_) Look();
  }

 private:
  void Look();

  std::size_t done_ = 0;
  std::size_t total_;
  std::size_t next_look_;  // the clock is not asked at every point
  double start_s_;
  double next_line_s_;
  bool terminal_;
  bool visible_ = false;
};

}  // namespace stipple::raytracer

#endif
