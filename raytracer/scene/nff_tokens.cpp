// SPDX-License-Identifier: MIT
#include "raytracer/scene/nff_tokens.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

constexpr double kLargest = 1e30;
constexpr std::size_t kShownCharacters = 40;
// The window is moved before less of it is left.
constexpr std::size_t kRoomForToken = 1024;

bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool EndsToken(char c) { return IsBlank(c) || c == '#'; }

}  // namespace

std::string Shown(std::string_view token) {
  std::string shown;
  for (const char c : token.substr(0, kShownCharacters)) shown += c >= ' ' && c <= '~' ? c : '?';
  return token.size() > kShownCharacters ? shown + "..." : shown;
}

NffTokens::NffTokens(Text& text, std::string_view name)
    : text_(text), window_(text.window()), name_(name) {
  if (window_.starts_with("\xef\xbb\xbf")) position_ = 3;
  Skip();
}

void NffTokens::Fail(long line, std::string_view problem) const {
  throw InputError(name_, line, problem);
}

void NffTokens::Skip() {
  SkipInWindow();
  if (window_.size() - position_ < kRoomForToken && !text_.WindowReachesEnd()) [[unlikely]] {
    do MoveWindow(), SkipInWindow();
    while (AtEnd() && !text_.WindowReachesEnd());
  }
}

void NffTokens::MoveWindow() {
  text_.Move(position_);
  window_ = text_.window();
  position_ = 0;
}

void NffTokens::SkipInWindow() {
  std::size_t next = position_;
  long line = line_met_;
  while (next < window_.size() && (in_comment_ || EndsToken(window_[next]))) {
    if (in_comment_ || window_[next] == '#') {
      while (next < window_.size() && window_[next] != '\n' && window_[next] != '\r') ++next;
      in_comment_ = next == window_.size();
      continue;
    }
    if (window_[next] == '\n') ++line;
    ++next;
  }
  position_ = next;
  line_met_ = line;
  if (next < window_.size())
    line_ = line;  // at the end the last token's line says more than an empty line
}

std::string_view NffTokens::Peek() {
  std::size_t length = 0;
  for (;;) {
    while (position_ + length < window_.size() && !EndsToken(window_[position_ + length])) ++length;
    if (position_ + length < window_.size() || text_.WindowReachesEnd())
      return window_.substr(position_, length);
    MoveWindow();
  }
}

void NffTokens::Take() {
  position_ += Peek().size();
  Skip();
}

bool NffTokens::NumberFollows() const {
  if (AtEnd()) return false;
  const char c = window_[position_];
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

double NffTokens::Number(std::string_view what) {
  const char* const begin = window_.data() + position_;
  const char* const last = window_.data() + window_.size();
  double value = 0;
  const auto [end, error] = std::from_chars(begin, last, value);
  // The usual number is done; NaN is not, since it compares with nothing.
  if (error == std::errc() && (end == last ? text_.WindowReachesEnd() : EndsToken(*end)) &&
      std::abs(value) <= kLargest) [[likely]]
    position_ += static_cast<std::size_t>(end - begin);
  else {
    value = UnusualNumber(what);
    position_ += Peek().size();
  }
  Skip();
  return value;
}

/// With a plus sign, too small for a double, cut by the window, or none that can be used.
double NffTokens::UnusualNumber(std::string_view what) {
  if (AtEnd()) Fail(fmt::format("the file ends where {} should be", what));
  const std::string_view token = Peek();
  const std::string_view digits = token.substr(token.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
    Fail(fmt::format("{} should be a number, found '{}'", what, Shown(token)));
  // Out of range is either: too small, which strtod rounds to zero or nearly, or too large, which
  // it makes infinite.
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(digits).c_str(), nullptr);
  if (!std::isfinite(value)) Fail(fmt::format("{} is not a finite number: {}", what, Shown(token)));
  if (std::abs(value) > kLargest) Fail(fmt::format("{} is too large: {}", what, Shown(token)));
  return value;
}

Vec3 NffTokens::Vector(std::string_view what) {
  const double x = Number(what);
  const double y = Number(what);
  const double z = Number(what);
  return {x, y, z};
}

long NffTokens::Count(std::string_view what, long low, long high) {
  const long line = line_;
  const double value = Number(what);
  if (value != std::floor(value)) Fail(line, fmt::format("{} should be a whole number", what));
  if (value < static_cast<double>(low) || value > static_cast<double>(high))
    Fail(line, fmt::format("{} is {}, it should be from {} to {}", what, value, low, high));
  return static_cast<long>(value);
}

}  // namespace stipple::raytracer
