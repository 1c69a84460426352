// SPDX-License-Identifier: MIT
// SHA-256: names of results that must be the same on every machine.
#ifndef STIPPLE_ANALYSIS_TRACE_SHA256_H
#define STIPPLE_ANALYSIS_TRACE_SHA256_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace stipple {

/// Source: FIPS 180-4, Secure Hash Standard, 2015.
class Sha256 {
 public:
  void Add(std::span<const std::byte> bytes);
  /// 64 hexadecimal digits; nothing can be added afterwards.
  std::string Digits();

 private:
  void AddBlock();

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> block_{};
  std::size_t in_block_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace stipple

#endif
