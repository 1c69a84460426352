// SPDX-License-Identifier: MIT
#include "analysis/views/window/facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string Ascii(const std::string& text) {
  std::string ascii;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 32 && byte < 127)
      ascii += c;
    else if (byte >= 0xc0 || byte < 32)
      ascii += '?';
  }
  return ascii;
}

std::string Length(std::int64_t ns) { return FormatSeconds(Seconds(ns)); }

/// As its row is called.
std::string NameOfRank(const Timeline& whole, int rank) {
  const auto row = std::ranges::find(whole.rows, rank, &TimelineRow::rank);
  if (row == whole.rows.end() || row->name.empty()) return std::to_string(rank);
  return CleanUtf8(row->name);
}

void AddMessage(std::vector<Fact>& facts, const RunMessage& m, const Timeline& whole) {
  facts.push_back({"message", fmt::format("{} \u2192 {}", NameOfRank(whole, m.sender),
                                          NameOfRank(whole, m.receiver))});
  facts.push_back({"tag", std::to_string(m.tag)});
  facts.push_back({"bytes", FormatCount(static_cast<std::int64_t>(m.bytes))});
  facts.push_back({"sent", ExactTime(Seconds(m.send_ns))});
  if (!m.send_call.empty()) facts.push_back({"by", m.send_call});
  facts.push_back({"posted", ExactTime(Seconds(m.post_ns))});
  facts.push_back({"received", ExactTime(Seconds(m.receive_ns))});
  if (!m.receive_call.empty()) facts.push_back({"by", m.receive_call});
  facts.push_back({"took", m.receive_ns >= m.send_ns ? Length(m.receive_ns - m.send_ns)
                                                     : "-" + Length(m.send_ns - m.receive_ns)});
}

}  // namespace

std::string ExactTime(double time_s) { return fmt::format("{:.9f} s", time_s); }

TimeSpan SpanOf(const Picked& picked) {
  if (picked.message)
    return {Seconds(std::min(picked.message->send_ns, picked.message->receive_ns)),
            Seconds(std::max(picked.message->send_ns, picked.message->receive_ns))};
  if (picked.visit) return {Seconds(picked.visit->begin_ns), Seconds(picked.visit->end_ns)};
  if (picked.call) return {Seconds(picked.call->begin_ns), Seconds(picked.call->end_ns)};
  return {picked.time_s, picked.time_s};
}

std::vector<Fact> FactsOf(const Picked& picked, const WindowSource& source, const Timeline& whole) {
  std::vector<Fact> facts;
  const std::string noun(NounFor(whole));
  facts.push_back({noun, NameOfRank(whole, picked.rank)});
  facts.push_back({"at", ExactTime(picked.time_s)});
  if (picked.visit) {
    facts.push_back({"function", source.RegionName(picked.visit->region)});
    facts.push_back({"begin", ExactTime(Seconds(picked.visit->begin_ns))});
    facts.push_back({"end", ExactTime(Seconds(picked.visit->end_ns))});
    facts.push_back({"length", Length(picked.visit->end_ns - picked.visit->begin_ns)});
  }
  const bool same_call = picked.call && picked.visit && picked.call->region == picked.visit->region;
  if (picked.call) {
    if (!same_call) {
      facts.push_back({"MPI call", source.RegionName(picked.call->region)});
      facts.push_back({"length", Length(picked.call->end_ns - picked.call->begin_ns)});
    }
    if (picked.call->idle_ns > 0) {
      facts.push_back({"waited", Length(picked.call->idle_ns)});
      if (picked.call->partner >= 0)
        facts.push_back({"for " + noun, NameOfRank(whole, picked.call->partner)});
    }
  }
  if (picked.message) AddMessage(facts, *picked.message, whole);
  std::string path;
  for (const std::string& name : picked.path) path += (path.empty() ? "" : " \u203a ") + name;
  if (!path.empty()) facts.push_back({"within", path});
  return facts;
}

std::string FactsLine(const Picked& picked, const WindowSource& source) {
  std::string line = fmt::format("rank {}", picked.rank);
  if (picked.visit)
    line += fmt::format(", {}, {} to {}", source.RegionName(picked.visit->region),
                        ExactTime(Seconds(picked.visit->begin_ns)),
                        ExactTime(Seconds(picked.visit->end_ns)));
  else if (picked.call)
    line += fmt::format(", {}, {} to {}", source.RegionName(picked.call->region),
                        ExactTime(Seconds(picked.call->begin_ns)),
                        ExactTime(Seconds(picked.call->end_ns)));
  else
    line += ", " + ExactTime(picked.time_s);
  if (picked.message)
    line += fmt::format(", message from {} to {}, tag {}, {} bytes, sent {}, received {}",
                        picked.message->sender, picked.message->receiver, picked.message->tag,
                        picked.message->bytes, ExactTime(Seconds(picked.message->send_ns)),
                        ExactTime(Seconds(picked.message->receive_ns)));
  return Ascii(line);
}

std::string TitleOf(const ViewState& state, const WindowSource& source) {
  std::string title =
      fmt::format("stipple view {} | {} to {} | ranks {} of {}", source.Title(),
                  ExactTime(state.visible().begin_s), ExactTime(state.visible().end_s),
                  state.ranks().size(), source.Ranks().size());
  if (state.has_cursor())
    title += fmt::format(" | {} at {}", state.playing() ? "playing" : "cursor",
                         ExactTime(state.cursor_s()));
  if (state.help) title += " | help";
  if (state.typing) title += " | search: " + state.search;
  if (!state.message.empty()) title += " | " + state.message;
  if (state.picked) title += " | " + FactsLine(*state.picked, source);
  return Ascii(title);
}

}  // namespace stipple
