// SPDX-License-Identifier: MIT
#include "raytracer/render/mail.h"

namespace stipple::raytracer {

Mail::~Mail() {
  for (Posted& letter : under_way_) MPI_Wait(&letter.request, MPI_STATUS_IGNORE);
}

void Mail::PostBytes(int to, int tag, std::span<const std::byte> bytes) {
  // Only the oldest is asked after: each question has its price, and most letters go in order.
  for (int done = 1; !under_way_.empty() && done != 0;) {
    MPI_Test(&under_way_.front().request, &done, MPI_STATUS_IGNORE);
    if (done != 0) under_way_.pop_front();
  }
  Posted& letter = under_way_.emplace_back();
  letter.body.assign(bytes.begin(), bytes.end());
  MPI_Isend(letter.body.data(), static_cast<int>(letter.body.size()), MPI_BYTE, to, tag,
            world_.comm, &letter.request);
  ++posted_;
}

bool Mail::Take(bool wait, Letter& letter) {
  MPI_Status status;
  status.MPI_SOURCE = MPI_ANY_SOURCE;
  status.MPI_TAG = MPI_ANY_TAG;
  auto bytes = static_cast<int>(most_bytes_);
  if (!wait) {
    int there = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, world_.comm, &there, &status);
    if (there == 0) return false;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
  }
  // Who waits receives at once: MPI_Probe may look again and again, which a simulated machine
  // has to play step by step.
  letter.body.resize(static_cast<std::size_t>(bytes));
  MPI_Recv(letter.body.data(), bytes, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, world_.comm,
           &status);
  MPI_Get_count(&status, MPI_BYTE, &bytes);
  letter.from = status.MPI_SOURCE;
  letter.tag = status.MPI_TAG;
  letter.body.resize(static_cast<std::size_t>(bytes));
  return true;
}

}  // namespace stipple::raytracer
