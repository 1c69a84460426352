// SPDX-License-Identifier: MIT
#include "analysis/stats/finding_words.h"

#include <algorithm>
#include <cctype>

namespace stipple {
namespace {

// More ranks or spans of ranks than this are counted, not listed.
constexpr std::size_t kMostListed = 6;

constexpr std::string_view kIfSpread = "if the work were spread evenly";

constexpr CauseWords kCauses[] = {
    {"late-sender", "its messages come late", "their messages come late", "", true, kIfSpread},
    {"late-receiver", "it receives late", "they receive late", "", true, kIfSpread},
    {"wait-at-barrier", "it comes last to barriers", "they come last to barriers", "", true,
     kIfSpread},
    {"wait-at-collective", "it comes last to collective calls",
     "they come last to collective calls", "", true, kIfSpread},
    {"end-imbalance", "it still works when they have nothing left",
     "they still work when nobody else has anything left", "", true, kIfSpread},
    {"master-starvation", "it serves them one by one and is too slow",
     "they serve them one by one and are too slow", "", false, "if requests were answered at once"},
    {"serialisation", "they take turns, and its turn is the longest",
     "they take turns, and those take the longest", "they take turns", false,
     "if they did not depend on each other's turns"},
    {"head-of-line", "its messages are taken first, although others are there",
     "their messages are taken first, although others are there",
     "messages that are there are taken last", false, "if messages were taken as they come"},
    {"message-overhead", "", "", "", false, ""},
    {"imbalance", "", "", "now one is late, now another", true, kIfSpread}};

constexpr CauseWords kUnknown{"", "", "", "", false, ""};

}  // namespace

const CauseWords& WordsOf(std::string_view cause) {
  const auto* words = std::ranges::find(kCauses, cause, &CauseWords::cause);
  return words == std::end(kCauses) ? kUnknown : *words;
}

std::string RankWords::One(int rank) const {
  return trace_.IsHost(rank) ? "the host" : noun_ + " " + std::to_string(rank);
}

std::string RankWords::Many(std::vector<int> ranks) const {
  std::ranges::sort(ranks);
  const std::size_t count = ranks.size();
  const bool host = std::erase_if(ranks, [this](int r) { return trace_.IsHost(r); }) > 0;
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < ranks.size();) {
    std::size_t j = i;
    while (j + 1 < ranks.size() && ranks[j + 1] == ranks[j] + 1) ++j;
    if (j == i + 1) j = i;  // two are two, not a span
    parts.push_back(std::to_string(ranks[i]));
    if (j > i) parts.back() += "-" + std::to_string(ranks[j]);
    i = j + 1;
  }
  if (parts.empty()) return "the host";
  if (host) parts.emplace_back("the host");
  if (parts.size() > kMostListed) return std::to_string(count) + " " + noun_ + "s";
  std::string list = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i)
    list += (i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return noun_ + (ranks.size() > 1 ? "s " : " ") + list;
}

std::string Capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace stipple
