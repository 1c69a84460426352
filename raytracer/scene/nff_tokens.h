// SPDX-License-Identifier: MIT
// Words and numbers of an NFF text, each with the line it stands on.
#ifndef STIPPLE_RAYTRACER_SCENE_NFF_TOKENS_H
#define STIPPLE_RAYTRACER_SCENE_NFF_TOKENS_H

#include <cstddef>
#include <string>
#include <string_view>

#include "raytracer/geometry/vec.h"
#include "raytracer/scene/file_bytes.h"

namespace stipple::raytracer {

class NffTokens {
 public:
  /// Both are looked at as long as this lives. A byte order mark at the beginning is none of the
  /// text's words.
  NffTokens(Text& text, std::string_view name);

  bool AtEnd() const { return position_ == window_.size(); }
  /// Line of the next token; at the end, the last line.
  long line() const { return line_; }
  /// The next token, which stays; empty at the end. It can be looked at until it is taken.
  std::string_view Peek();
  void Take();
  /// Could the next token begin a number?
  bool NumberFollows() const;

  /// `what` says in messages which number is missing or wrong. Errors: InputError; also for NaN,
  /// infinity, and magnitudes above 1e30, whose squares and cubes would not stay finite.
  double Number(std::string_view what);
  Vec3 Vector(std::string_view what);
  /// A whole number from low to high.
  long Count(std::string_view what, long low, long high);

  /// Numbers that the rest of the text could hold at most.
  std::size_t NumbersLeftAtMost() const {
    return (window_.size() - position_ + text_.MostBytesBehind() + 1) / 2;
  }

  [[noreturn]] void Fail(std::string_view problem) const { Fail(line_, problem); }
  [[noreturn]] void Fail(long line, std::string_view problem) const;

 private:
  void Skip();  // blanks and comments
  void SkipInWindow();
  void MoveWindow();
  double UnusualNumber(std::string_view what);

  Text& text_;
  std::string_view window_;  // of the text
  std::string_view name_;
  std::size_t position_ = 0;  // in the window
  bool in_comment_ = false;   // that the window has cut
  long line_ = 1, line_met_ = 1;
};

/// A token as a message may show it: not endless, and without bytes that disturb a terminal.
std::string Shown(std::string_view token);

}  // namespace stipple::raytracer

#endif
