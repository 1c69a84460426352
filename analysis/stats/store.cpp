// SPDX-License-Identifier: MIT
#include "analysis/stats/store.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/trace/index_file.h"
#include "analysis/trace/stream_index.h"

namespace stipple {
namespace {

/// All that is kept of an analysis: one row each. A part is a number, plain structs in an Array or
/// a vector, one of those for each location, a health record, or an optional vector, which is kept
/// once somebody has asked for it. `a` is const when it is saved.
template <class SomeAnalysis, class Part>
void ForEachPart(SomeAnalysis& a, Part&& part) {
  part("profiles", a.profiles);
  part("calls", a.mpi.calls);
  part("sends", a.mpi.sends);
  part("receives", a.mpi.receives);
  part("probes", a.mpi.probes);
  part("collectives", a.mpi.collectives);
  part("transmissions", a.mpi.transmissions);
  part("marks", a.mpi.marks);
  part("thread_messages", a.mpi.thread_messages.matched);
  part("thread_unmatched", a.mpi.thread_messages.unmatched);
  part("matched", a.mpi.matched);
  part("reversed", a.mpi.reversed);
  part("bytes", a.mpi.bytes);
  part("mpi_health", a.mpi.health);
  part("waits", a.waits);
  part("steps", a.steps);
  part("kernel", a.kernel);
  part("sums.calls", a.sums.calls);
  part("sums.kernel", a.sums.kernel);
  part("sums.messages", a.sums.messages);
  part("sums.completions", a.sums.completions);
  part("sums.latest", a.sums.latest);
  part("health", a.health);
  part("blames", a.blames);
  part("path", a.path);
  part("path_rows", a.path_rows);
  part("phases", a.phases);
  part("split", a.split);
  part("overheads", a.overheads);
  part("paths", a.paths);
  part("sample_paths", a.sample_paths);
}

class Saver {
 public:
  explicit Saver(IndexWriter& to) : to_(to) {}

  template <class T>
  void operator()(const char* name, const Array<T>& items) {
    to_.Add(name, std::span<const T>(items));
  }
  template <class T>
  void operator()(const char* name, const std::vector<T>& items) {
    to_.Add(name, std::span<const T>(items));
  }
  template <class T>
  void operator()(const char* name, const std::optional<std::vector<T>>& items) {
    if (items) (*this)(name, *items);
  }
  template <class T>
  void operator()(const char* name, const std::optional<std::vector<std::vector<T>>>& by_location) {
    if (by_location) (*this)(name, *by_location);
  }
  void operator()(const char* name, const std::uint64_t& number) {
    to_.Add(name, std::span(&number, 1));
  }
  void operator()(const char* name, const TraceHealth& health) {
    ByteWriter bytes;
    PutHealth(health, bytes);
    to_.AddBytes(name, bytes.bytes());
  }
  template <class T>
  void operator()(const char* name, const std::vector<std::vector<T>>& by_location) {
    AddAll<T>(name, by_location);
  }
  template <class T>
  void operator()(const char* name, const std::vector<Array<T>>& by_location) {
    AddAll<T>(name, by_location);
  }

 private:
  template <class T, class Parts>
  void AddAll(const std::string& name, const Parts& by_location) {
    std::vector<std::uint64_t> counts;
    to_.Begin(name, sizeof(T));
    for (const auto& items : by_location) {
      counts.push_back(items.size());
      to_.Append(std::as_bytes(std::span<const T>(items)));
    }
    to_.End();
    to_.Add(name + ".counts", std::span<const std::uint64_t>(counts));
  }

  IndexWriter& to_;
};

class Loader {
 public:
  Loader(const IndexFile& from, std::size_t locations) : from_(from), locations_(locations) {}

  bool complete() const { return complete_; }

  template <class T>
  void operator()(const char* name, Array<T>& items) {
    if (const auto found = from_.Get<T>(name); found)
      items = *found;
    else
      complete_ = false;
  }
  template <class T>
  void operator()(const char* name, std::vector<T>& items) {
    Array<T> found;
    (*this)(name, found);
    items.assign(found.begin(), found.end());
  }
  template <class T>
  void operator()(const char* name, std::optional<std::vector<T>>& items) {
    if (const auto found = from_.Get<T>(name); found) items.emplace(found->begin(), found->end());
  }
  template <class T>
  void operator()(const char* name, std::optional<std::vector<std::vector<T>>>& by_location) {
    if (from_.Get<T>(name)) (*this)(name, by_location.emplace());
  }
  void operator()(const char* name, std::uint64_t& number) {
    Array<std::uint64_t> found;
    (*this)(name, found);
    if (found.size() == 1)
      number = found.front();
    else
      complete_ = false;
  }
  void operator()(const char* name, TraceHealth& health) {
    ByteReader bytes(from_.Bytes(name));
    health = GetHealth(bytes);
    complete_ = complete_ && bytes.Done();
  }
  template <class T>
  void operator()(const char* name, std::vector<std::vector<T>>& by_location) {
    by_location.clear();
    for (const std::span<const T> items : Parts<T>(name))
      by_location.emplace_back(items.begin(), items.end());
  }
  template <class T>
  void operator()(const char* name, std::vector<Array<T>>& by_location) {
    by_location.clear();
    for (const std::span<const T> items : Parts<T>(name))
      by_location.emplace_back(items, from_.shared_from_this());
  }

 private:
  /// What each location has; all of it lies in one section.
  template <class T>
  std::vector<std::span<const T>> Parts(const std::string& name) {
    const auto all = from_.Get<T>(name);
    const auto counts = from_.Get<std::uint64_t>(name + ".counts");
    std::vector<std::span<const T>> parts;
    complete_ = complete_ && all && counts && counts->size() == locations_;
    if (!complete_) return parts;
    std::span<const T> rest(*all);
    for (const std::uint64_t count : *counts) {
      complete_ = complete_ && count <= rest.size();
      if (!complete_) return {};
      parts.push_back(rest.first(count));
      rest = rest.subspan(count);
    }
    complete_ = rest.empty();
    return parts;
  }

  const IndexFile& from_;
  std::size_t locations_;
  bool complete_ = true;
};

}  // namespace

bool LoadAnalysis(Analysis& analysis) {
  const auto& index = analysis.trace.index();
  if (index == nullptr) return false;
  Loader loader(*index, analysis.trace.locations().size());
  ForEachPart(analysis, loader);
  return loader.complete() && analysis.waits.size() == analysis.mpi.calls.size();
}

void SaveAnalysis(const Analysis& analysis) {
  analysis.trace.SaveIndex([&](IndexWriter& to) {
    Saver saver(to);
    ForEachPart(analysis, saver);
  });
}

}  // namespace stipple
