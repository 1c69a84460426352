// SPDX-License-Identifier: MIT
// Messages that come when they come: whoever works by what arrives posts and takes letters.
#ifndef STIPPLE_RAYTRACER_RENDER_MAIL_H
#define STIPPLE_RAYTRACER_RENDER_MAIL_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <list>
#include <span>
#include <type_traits>
#include <vector>

#include "raytracer/render/world.h"

namespace stipple::raytracer {

struct Letter {
  int from = 0, tag = 0;
  std::vector<std::byte> body;

  /// The body as things of one kind.
  template <class Thing>
  std::vector<Thing> Of() const {
    static_assert(std::is_trivially_copyable_v<Thing>);
    std::vector<Thing> things(body.size() / sizeof(Thing));
    if (!things.empty()) std::memcpy(things.data(), body.data(), body.size());
    return things;
  }
};

class Mail {
 public:
  /// No letter has more than `most_bytes`.
  Mail(const World& world, std::size_t most_bytes) : world_(world), most_bytes_(most_bytes) {}
  /// Waits until all that was posted has been taken over.
  ~Mail();
  Mail(const Mail&) = delete;
  Mail& operator=(const Mail&) = delete;

  /// Sends a copy and does not wait.
  template <class Thing>
  void Post(int to, int tag, std::span<const Thing> things) {
    static_assert(std::is_trivially_copyable_v<Thing>);
    PostBytes(to, tag, std::as_bytes(things));
  }
  template <class Thing>
  void Post(int to, int tag, const Thing& thing) {
    Post(to, tag, std::span<const Thing>(&thing, 1));
  }

  /// The next letter; if none is there, waits for one, or returns false.
  bool Take(bool wait, Letter& letter);

  std::uint64_t posted() const { return posted_; }

 private:
  struct Posted {
    std::vector<std::byte> body;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void PostBytes(int to, int tag, std::span<const std::byte> bytes);

  const World& world_;
  std::size_t most_bytes_;
  std::list<Posted> under_way_;  // in their order
  std::uint64_t posted_ = 0;
};

}  // namespace stipple::raytracer

#endif
