// SPDX-License-Identifier: MIT
// Small things to bytes and back, for the saved index. Reading stops at the first thing that does
// not fit, and says so.
#ifndef STIPPLE_ANALYSIS_TRACE_BYTES_H
#define STIPPLE_ANALYSIS_TRACE_BYTES_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace stipple {

class ByteWriter {
 public:
  template <class T>
  void Put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void PutText(std::string_view text) {
    Put(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
  }
  template <class T>
  void PutAll(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Put(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  /// All that was read so far was there.
  bool sound() const { return sound_; }
  /// And nothing is left.
  bool Done() const { return sound_ && rest_.empty(); }

  template <class T>
  T Get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    if (Has(sizeof(T))) {
      std::memcpy(&value, rest_.data(), sizeof(T));
      rest_.remove_prefix(sizeof(T));
    }
    return value;
  }
  std::string GetText() {
    const auto size = Get<std::uint64_t>();
    if (!Has(size)) return {};
    std::string text(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return text;
  }
  template <class T>
  std::vector<T> GetAll() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = Get<std::uint64_t>();
    if (count > rest_.size() / sizeof(T)) sound_ = false;
    if (!sound_) return {};
    std::vector<T> values(count);
    if (count != 0) std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
    return values;
  }

 private:
  bool Has(std::uint64_t bytes) {
    if (bytes > rest_.size()) sound_ = false;
    return sound_;
  }
  std::string_view rest_;
  bool sound_ = true;
};

}  // namespace stipple

#endif
