// SPDX-License-Identifier: MIT
#include "analysis/stats/run_hash.h"

#include <algorithm>
#include <bit>
#include <concepts>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "analysis/trace/sha256.h"

namespace stipple {
namespace {

/// Writes what counts of a location's records as words, lowest byte first, and texts.
struct HashVisitor {
  const Trace& trace;
  const Location& location;
  std::string bytes = {};

  void Function(std::uint32_t, bool, std::uint64_t) {}

  void Record(const EventWord* record, std::uint64_t ticks) {
    switch (KindOf(*record)) {
      case RecordKind::kMark:
        return Add(record, ticks, Name(RecordAt<Mark>(record).name));
      case RecordKind::kCounter: {
        const auto r = RecordAt<Counter>(record);
        return Add(record, ticks, Name(r.name), std::bit_cast<std::uint64_t>(r.value));
      }
      case RecordKind::kMpiSend: {
        const auto r = RecordAt<MpiSend>(record);
        return Add(record, ticks, r.bytes, r.communicator, r.receiver, r.tag, r.request);
      }
      case RecordKind::kMpiReceivePost: {
        const auto r = RecordAt<MpiReceivePost>(record);
        return Add(record, ticks, r.communicator, r.request);
      }
      case RecordKind::kMpiReceive: {
        const auto r = RecordAt<MpiReceive>(record);
        return Add(record, ticks, r.bytes, r.communicator, r.sender, r.tag, r.request);
      }
      case RecordKind::kMpiCollective: {
        const auto r = RecordAt<MpiCollective>(record);
        return Add(record, ticks, r.bytes_sent, r.bytes_received, r.communicator, r.root);
      }
      default:
        return;
    }
  }

 private:
  std::string_view Name(std::uint32_t name) const {
    return trace.names()[trace.ProcessOf(location).NameOf(name)].text;
  }

  template <class... Values>
  void Add(const EventWord* record, std::uint64_t ticks, Values... values) {
    AddOne(static_cast<std::uint64_t>(KindOf(*record)));
    AddOne(ticks);
    (AddOne(values), ...);
  }
  void AddOne(std::string_view text) {
    AddOne(std::uint64_t{text.size()});
    bytes += text;
  }
  template <class Number>
  requires std::integral<Number>
  void AddOne(Number number) {
    const auto word = static_cast<std::uint64_t>(number);
    for (int shift = 0; shift < 64; shift += 8)
      bytes += static_cast<char>(static_cast<unsigned char>(word >> shift));
  }
};

}  // namespace

std::string RunHashOf(const Trace& trace) {
  std::vector<const Location*> locations;
  for (const Location& l : trace.locations()) locations.push_back(&l);
  std::vector<std::string> bytes(locations.size());
  trace.ForEachOf(locations, "hash", [&](const Location& l) {
    HashVisitor visitor{trace, l};
    trace.Scan(l, visitor);
    bytes[l.index] = std::move(visitor.bytes);
  });
  std::ranges::sort(locations, {},
                    [](const Location* l) { return std::tuple(l->rank, l->process, l->thread); });
  Sha256 hash;
  for (const Location* l : locations) hash.Add(std::as_bytes(std::span(bytes[l->index])));
  return hash.Digits();
}

}  // namespace stipple
