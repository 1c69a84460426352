// SPDX-License-Identifier: MIT
// All ranks of a simulation are one process: memory that the first of them takes is seen by all.
#include "raytracer/scene/node_memory.h"

#include <cstdint>
#include <cstdlib>
#include <utility>

#include "raytracer/simulate/machine.h"

namespace stipple::raytracer {
namespace {

constexpr std::size_t kCacheLine = 64;

}  // namespace

std::uint64_t AvailableBytes() { return simulate::ThisNode().memory_bytes; }

Node::Node(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

Node::~Node() = default;

std::uint64_t Node::BytesForEach() const { return AvailableBytes(); }

/// All of the process can what one can.
bool Node::All(bool mine) const { return mine; }

NodeMemory::NodeMemory(const Node& node, std::size_t bytes) {
  // Kept until the process ends: ranks end one by one.
  if (node.leads()) {
    const std::size_t whole = (bytes + kCacheLine - 1) / kCacheLine * kCacheLine;
    simulate::SharedPlace() = std::aligned_alloc(kCacheLine, whole);
  }
  std::uint64_t size = bytes;
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, node.comm());
  if (simulate::SharedPlace() != nullptr)
    block_ = {static_cast<std::byte*>(simulate::SharedPlace()), static_cast<std::size_t>(size)};
}

NodeMemory::NodeMemory(NodeMemory&& other) noexcept { *this = std::move(other); }

NodeMemory& NodeMemory::operator=(NodeMemory&& other) noexcept {
  std::swap(window_, other.window_);
  std::swap(block_, other.block_);
  return *this;
}

NodeMemory::~NodeMemory() = default;

void NodeMemory::Publish() const { MPI_Barrier(MPI_COMM_WORLD); }

}  // namespace stipple::raytracer
