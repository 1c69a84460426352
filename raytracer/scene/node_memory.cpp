// SPDX-License-Identifier: MIT
#include "raytracer/scene/node_memory.h"

#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

namespace stipple::raytracer {
namespace {

constexpr std::size_t kCacheLine = 64;

}  // namespace

std::uint64_t AvailableBytes() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word)
    if (std::uint64_t kib = 0; word == "MemAvailable:" && file >> kib) return kib * 1024;
  return std::numeric_limits<std::uint64_t>::max();
}

Node::Node(MPI_Comm comm) {
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

Node::~Node() { MPI_Comm_free(&comm_); }

std::uint64_t Node::BytesForEach() const {
  return AvailableBytes() / static_cast<std::uint64_t>(size_);
}

bool Node::All(bool mine) const {
  const int one = mine ? 1 : 0;
  int all = one;
  MPI_Allreduce(&one, &all, 1, MPI_INT, MPI_MIN, comm_);
  return all != 0;
}

NodeMemory::NodeMemory(const Node& node, std::size_t bytes) {
  std::uint64_t size = bytes;
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, node.comm());
  // A node's shared memory may be small (that of a container is 64 MB); then this fails, and the
  // caller has another way.
  MPI_Comm_set_errhandler(node.comm(), MPI_ERRORS_RETURN);
  const MPI_Aint own =
      node.leads() ? static_cast<MPI_Aint>(size + kCacheLine) : static_cast<MPI_Aint>(0);
  void* base = nullptr;
  const bool made =
      MPI_Win_allocate_shared(own, 1, MPI_INFO_NULL, node.comm(), &base, &window_) == MPI_SUCCESS;
  if (!node.All(made)) return;  // a window that only some have cannot be freed
  MPI_Aint all = 0;
  int unit = 1;
  MPI_Win_shared_query(window_, 0, &all, &unit, &base);
  // The same place on every rank, since their mappings differ by whole pages.
  const auto address = reinterpret_cast<std::uintptr_t>(base);
  const std::size_t skip = (kCacheLine - address % kCacheLine) % kCacheLine;
  block_ = {static_cast<std::byte*>(base) + skip, static_cast<std::size_t>(size)};
  MPI_Win_fence(0, window_);
}

NodeMemory::NodeMemory(NodeMemory&& other) noexcept { *this = std::move(other); }

NodeMemory& NodeMemory::operator=(NodeMemory&& other) noexcept {
  std::swap(window_, other.window_);
  std::swap(block_, other.block_);
  return *this;
}

NodeMemory::~NodeMemory() {
  if (!block_.empty()) MPI_Win_free(&window_);
}

void NodeMemory::Publish() const { MPI_Win_fence(0, window_); }

}  // namespace stipple::raytracer
