// SPDX-License-Identifier: MIT
// The ranks of one computer, and memory that they share.
#ifndef STIPPLE_RAYTRACER_SCENE_NODE_MEMORY_H
#define STIPPLE_RAYTRACER_SCENE_NODE_MEMORY_H

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace stipple::raytracer {

/// Bytes that processes on this computer can still get (MemAvailable of /proc/meminfo), or the
/// largest number where that is not known; of a simulated node, all that it has.
std::uint64_t AvailableBytes();

/// The ranks that can share memory with this one; the first of them leads.
class Node {
 public:
  /// Every rank of `comm` calls it.
  explicit Node(MPI_Comm comm);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  MPI_Comm comm() const { return comm_; }
  int rank() const { return rank_; }
  int size() const { return size_; }
  bool leads() const { return rank_ == 0; }
  /// Of what is available, as much as one of its ranks may take if each has objects of its own. The
  /// ranks of a simulation share memory, but each is a node of the machine.
  std::uint64_t BytesForEach() const;
  /// Is it true on every rank of the node? All of them ask.
  bool All(bool mine) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
};

/// A block of memory that all ranks of a node see. Every rank of the node makes and destroys it,
/// before MPI_Finalize.
class NodeMemory {
 public:
  NodeMemory() = default;
  /// `bytes` counts on the leader. No block if there is no room for it.
  NodeMemory(const Node& node, std::size_t bytes);
  NodeMemory(NodeMemory&& other) noexcept;
  NodeMemory& operator=(NodeMemory&& other) noexcept;
  ~NodeMemory();

  /// Begins at a cache line; empty if there is no block.
  std::span<std::byte> block() const { return block_; }
  /// What the leader wrote before is seen by all after; every rank of the node calls it.
  void Publish() const;

 private:
  MPI_Win window_ = MPI_WIN_NULL;
  std::span<std::byte> block_;
};

}  // namespace stipple::raytracer

#endif
