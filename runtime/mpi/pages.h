// SPDX-License-Identifier: MIT
// Memory for the MPI layer, straight from the kernel: the program's malloc may be interposed,
// counted or, in a wrapper called from one of its hooks, not re-entrant.
#ifndef STIPPLE_RUNTIME_MPI_PAGES_H
#define STIPPLE_RUNTIME_MPI_PAGES_H

#include <sys/mman.h>

#include <cerrno>
#include <cstddef>

namespace stipple::mpi {

/// Zeroed pages that hold `bytes`; null if there are none. errno is left alone.
inline void* TakePages(std::size_t bytes) {
  const int saved = errno;
  void* pages =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, /*fd=*/-1, 0);
  errno = saved;
  return pages == MAP_FAILED ? nullptr : pages;
}

inline void GivePages(void* pages, std::size_t bytes) {
  if (pages != nullptr) munmap(pages, bytes);
}

/// An array that lives on the stack up to kInline elements and in pages of its own beyond. Not
/// initialised. Data() is null if there was no memory.
template <class T, std::size_t kInline>
class Scratch {
 public:
  explicit Scratch(std::size_t count) noexcept {
    if (count > kInline) {
      bytes_ = count * sizeof(T);  // NOLINT(bugprone-sizeof-expression): T may be a pointer
      data_ = static_cast<T*>(TakePages(bytes_));
    }
  }
  ~Scratch() {
    if (bytes_ != 0) GivePages(data_, bytes_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  T* Data() { return data_; }
  T& operator[](std::size_t index) { return data_[index]; }

 private:
  union {
    T inline_[kInline];
  };
  T* data_ = inline_;
  std::size_t bytes_ = 0;
};

}  // namespace stipple::mpi

#endif
