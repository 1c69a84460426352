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

bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool EndsToken(char c) { return IsBlank(c) || c == '#'; }

}  // namespace

std::string Shown(std::string_view token) {
  std::string shown;
  for (const char c : token.substr(0, kShownCharacters)) shown += c >= ' ' && c <= '~' ? c : '?';
  return token.size() > kShownCharacters ? shown + "..." : shown;
}

NffTokens::NffTokens(std::string_view text, std::string_view name) : text_(text), name_(name) {
  if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  Skip();
}

void NffTokens::Fail(long line, std::string_view problem) const {
  throw InputError(name_, line, problem);
}

void NffTokens::Skip() {
  std::size_t next = position_;
  long line = line_;
  while (next < text_.size() && EndsToken(text_[next])) {
    if (text_[next] == '#') {
      while (next < text_.size() && text_[next] != '\n' && text_[next] != '\r') ++next;
      continue;
    }
    if (text_[next] == '\n') ++line;
    ++next;
  }
  position_ = next;
  if (next < text_.size())
    line_ = line;  // at the end the last token's line says more than an empty line
}

std::string_view NffTokens::Peek() const {
  std::size_t end = position_;
  while (end < text_.size() && !EndsToken(text_[end])) ++end;
  return text_.substr(position_, end - position_);
}

std::string_view NffTokens::Take() {
  const std::string_view token = Peek();
  position_ += token.size();
  Skip();
  return token;
}

bool NffTokens::NumberFollows() const {
  if (AtEnd()) return false;
  const char c = text_[position_];
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

double NffTokens::Number(std::string_view what) {
  const char* const begin = text_.data() + position_;
  const char* const last = text_.data() + text_.size();
  double value = 0;
  const auto [end, error] = std::from_chars(begin, last, value);
  // The usual number is done; NaN is not, since it compares with nothing.
  if (error == std::errc() && (end == last || EndsToken(*end)) && std::abs(value) <= kLargest)
      [[likely]]
    position_ += static_cast<std::size_t>(end - begin);
  else {
    value = UnusualNumber(what);
    position_ += Peek().size();
  }
  Skip();
  return value;
}

/// With a plus sign, too small for a double, or none that can be used.
double NffTokens::UnusualNumber(std::string_view what) const {
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
