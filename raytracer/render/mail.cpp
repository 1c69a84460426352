// SPDX-License-Identifier: MIT
#include "raytracer/render/mail.h"

namespace stipple::raytracer {

Mail::~Mail() {
  for (Posted& letter : under_way_) MPI_Wait(&letter.request, MPI_STATUS_IGNORE);
}

void Mail::PostBytes(int to, int tag, std::span<const std::byte> bytes) {
  std::erase_if(under_way_, [](Posted& letter) {
    int done = 0;
    MPI_Test(&letter.request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  });
  Posted& letter = under_way_.emplace_back();
  letter.body.assign(bytes.begin(), bytes.end());
  MPI_Isend(letter.body.data(), static_cast<int>(letter.body.size()), MPI_BYTE, to, tag,
            world_.comm, &letter.request);
  ++posted_;
}

// Who waits waits in the receive itself: there a simulated machine finds that nothing will ever
// come, and a trace whom one waited for.
bool Mail::Take(bool wait, Letter& letter) {
  MPI_Status status;
  status.MPI_SOURCE = MPI_ANY_SOURCE;
  status.MPI_TAG = MPI_ANY_TAG;
  int there = 1;
  if (!wait) MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, world_.comm, &there, &status);
  if (there == 0) return false;
  MPI_Recv(room_.get(), static_cast<int>(most_bytes_), MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG,
           world_.comm, &status);
  int bytes = 0;
  MPI_Get_count(&status, MPI_BYTE, &bytes);
  letter.from = status.MPI_SOURCE;
  letter.tag = status.MPI_TAG;
  letter.body.assign(room_.get(), room_.get() + bytes);
  return true;
}

}  // namespace stipple::raytracer
