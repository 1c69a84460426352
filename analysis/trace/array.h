// SPDX-License-Identifier: MIT
// A vector that is either its own or lies in a mapped file: what a first pass made and what a saved
// index holds are read alike.
#ifndef STIPPLE_ANALYSIS_TRACE_ARRAY_H
#define STIPPLE_ANALYSIS_TRACE_ARRAY_H

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace stipple {

template <class T>
class Array {
 public:
  using value_type = T;
  using const_iterator = const T*;
  using iterator = const T*;

  Array() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a result becomes an array by being kept.
  Array(std::vector<T> own) : own_(std::move(own)) {}
  /// `keeper` keeps the memory of `view` alive.
  Array(std::span<const T> view, std::shared_ptr<const void> keeper)
      : view_(view), keeper_(std::move(keeper)) {}

  const T* data() const { return keeper_ == nullptr ? own_.data() : view_.data(); }
  std::size_t size() const { return keeper_ == nullptr ? own_.size() : view_.size(); }
  bool empty() const { return size() == 0; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size(); }
  const T& operator[](std::size_t i) const { return data()[i]; }
  const T& front() const { return data()[0]; }
  const T& back() const { return data()[size() - 1]; }

  /// For building: the own vector, a copy if it was a view.
  std::vector<T>& Edit() {
    if (keeper_ != nullptr) {
      own_.assign(view_.begin(), view_.end());
      view_ = {};
      keeper_.reset();
    }
    return own_;
  }

 private:
  std::vector<T> own_;
  std::span<const T> view_;
  std::shared_ptr<const void> keeper_;  // set: a view
};

}  // namespace stipple

#endif
