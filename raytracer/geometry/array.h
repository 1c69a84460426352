// SPDX-License-Identifier: MIT
// A read-only array that owns its elements, or looks at elements that lie elsewhere: in memory that
// the ranks of a node share, or in a mapped file.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_ARRAY_H
#define STIPPLE_RAYTRACER_GEOMETRY_ARRAY_H

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace stipple::raytracer {

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>, "the elements are copied as bytes");

 public:
  using Element = T;

  Array() = default;
  Array(std::vector<T> elements) : own_(std::move(elements)), view_(own_) {}
  /// The elements must outlive the array.
  explicit Array(std::span<const T> elsewhere) : view_(elsewhere) {}
  Array(Array&& other) noexcept { *this = std::move(other); }
  Array& operator=(Array&& other) noexcept {
    own_ = std::move(other.own_);  // a moved vector keeps its memory, so the view stays right
    view_ = std::exchange(other.view_, {});
    return *this;
  }

  const T& operator[](std::size_t i) const { return view_[i]; }
  const T* data() const { return view_.data(); }
  std::size_t size() const { return view_.size(); }
  bool empty() const { return view_.empty(); }
  auto begin() const { return view_.begin(); }
  auto end() const { return view_.end(); }

 private:
  std::vector<T> own_;
  std::span<const T> view_;
};

}  // namespace stipple::raytracer

#endif
