// SPDX-License-Identifier: MIT
// The part of the index that opening and scanning an archive find; what statistics find is added by
// stats/store.cpp.
#include <algorithm>
#include <filesystem>

#include "analysis/trace/stream_index.h"
#include "analysis/trace/trace.h"

namespace stipple {

void Trace::FindIndex(const std::vector<std::string>& files) {
  identity_ = IdentityOf(files);
  if (!policy_.use || identity_.stream_bytes < policy_.least_bytes) return;
  for (const std::string& place : IndexPlaces(path_)) {
    index_ = IndexFile::Open(place);
    if (index_ != nullptr && index_->Bytes("identity") == identity_.bytes) return;
    index_.reset();
  }
}

void Trace::LoadCounts() {
  if (index_ == nullptr) return;
  const auto counts = index_->Get<ScanCounts>("counts");
  if (!counts || counts->size() != locations_.size()) {
    index_.reset();  // of another archive than it says
    return;
  }
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts_[i] = (*counts)[i];
    const std::string number = std::to_string(i);
    if (const auto places = index_->Get<ScanAnchor>("anchors." + number); places)
      anchors_[i].places = *places;
    if (const auto open = index_->Get<OpenVisit>("open." + number); open) anchors_[i].open = *open;
  }
}

void Trace::SaveIndex(const std::function<void(IndexWriter&)>& add) const {
  if (!policy_.use || identity_.stream_bytes < policy_.least_bytes || !identity_.settled ||
      health_.Running())
    return;
  std::vector<ScanCounts> counts;
  for (const Location& l : locations_) counts.push_back(CountsOf(l));
  for (const std::string& place : IndexPlaces(path_)) {
    std::error_code error;
    std::filesystem::create_directories(std::filesystem::path(place).parent_path(), error);
    RemoveUnfinished(place);
    IndexWriter to(place);
    to.AddBytes("identity", identity_.bytes);
    for (std::size_t i = 0; i < streams_.size(); ++i)
      to.AddBytes("stream." + std::to_string(stream_numbers_[i]), SavedStream(*streams_[i]));
    to.Add("counts", std::span<const ScanCounts>(counts));
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      const std::string number = std::to_string(i);
      if (anchors_[i].places.empty()) continue;
      to.Add("anchors." + number, std::span<const ScanAnchor>(anchors_[i].places));
      to.Add("open." + number, std::span<const OpenVisit>(anchors_[i].open));
    }
    add(to);
    if (to.Finish()) return;
  }
}

}  // namespace stipple
