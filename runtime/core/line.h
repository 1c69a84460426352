// SPDX-License-Identifier: MIT
// A line of text put together without libc: for stderr and file names.
#ifndef STIPPLE_RUNTIME_CORE_LINE_H
#define STIPPLE_RUNTIME_CORE_LINE_H

#include <cstddef>
#include <cstdint>

#include "runtime/core/syscalls.h"

namespace stipple {

/// Text of at most `kBytes` - 1 bytes; what does not fit is cut off.
template <std::size_t kBytes>
class Line {
 public:
  Line& Add(const char* text) {
    while (text != nullptr && *text != '\0' && length_ < kBytes - 1) text_[length_++] = *text++;
    text_[length_] = '\0';
    return *this;
  }
  Line& Add(std::uint64_t number) {
    char digits[21];
    char* first = digits + 20;
    *first = '\0';
    do *--first = static_cast<char>('0' + number % 10);
    while ((number /= 10) != 0);
    return Add(first);
  }
  /// "0x1f40".
  Line& AddHex(std::uint64_t number) {
    char digits[19];
    char* first = digits + 18;
    *first = '\0';
    do *--first = "0123456789abcdef"[number & 15];
    while ((number >>= 4) != 0);
    *--first = 'x';
    *--first = '0';
    return Add(first);
  }
  /// Milliseconds as seconds with three decimals.
  Line& AddSeconds(std::uint64_t ms) {
    const char decimals[] = {'.', static_cast<char>('0' + ms / 100 % 10),
                             static_cast<char>('0' + ms / 10 % 10),
                             static_cast<char>('0' + ms % 10), '\0'};
    return Add(ms / 1000).Add(decimals);
  }
  const char* text() const { return text_; }
  std::size_t length() const { return length_; }
  bool full() const { return length_ == kBytes - 1; }
  void Print() const { Syscall(SYS_write, 2, Argument(text_), static_cast<long>(length_)); }

 private:
  char text_[kBytes] = {};
  std::size_t length_ = 0;
};

}  // namespace stipple

#endif
