// SPDX-License-Identifier: MIT
#include "analysis/exemplar/verdict.h"

#include <algorithm>
#include <utility>

namespace stipple {
namespace {

std::optional<Verdict> Joined(std::size_t holding, std::size_t refuted, std::size_t count) {
  if (count == 0) return std::nullopt;
  if (holding == count) return Verdict::kHolds;
  return refuted == count ? Verdict::kRefuted : Verdict::kInPart;
}

/// Settings that vary one parameter of one reference, that reference among them, by their place.
struct Row {
  std::string parameter;
  std::size_t reference = 0;
  std::vector<const PartsAt*> settings;
};

std::vector<Row> RowsOf(std::span<const PartsAt> settings) {
  std::vector<Row> rows;
  for (const PartsAt& s : settings.subspan(1)) {
    const Variation& v = s.variation;
    if (v.compared) continue;
    auto row = std::ranges::find_if(rows, [&v](const Row& r) {
      return r.parameter == v.parameter && r.reference == v.reference;
    });
    if (row == rows.end())
      row = rows.insert(rows.end(), {v.parameter, v.reference, {&settings[v.reference]}});
    row->settings.push_back(&s);
  }
  return rows;
}

bool IsReference(const Row& row, const PartsAt& setting) {
  return setting.variation.parameter != row.parameter;
}

void SortByPlace(Row& row) {
  std::ranges::stable_sort(row.settings, {}, [&row](const PartsAt* s) {
    return IsReference(row, *s) ? 0.0 : s->variation.place;
  });
}

std::string ValueIn(const Row& row, const PartsAt& setting) {
  if (!IsReference(row, setting)) return setting.variation.value;
  for (const PartsAt* s : row.settings)
    if (!IsReference(row, *s)) return s->variation.reference_value;
  return {};
}

void AddTurns(const Row& row, std::size_t part, std::vector<Turn>& turns) {
  const PartsAt* last = nullptr;
  for (const PartsAt* s : row.settings) {
    const std::optional<Verdict> now = VerdictOf(s->parts[part]);
    if (!now) continue;
    if (last != nullptr)
      if (const Verdict before = *VerdictOf(last->parts[part]); before != *now)
        turns.push_back({part, row.parameter, ValueIn(row, *last), ValueIn(row, *s), before, *now});
    last = s;
  }
}

}  // namespace

bool Check::Holds() const {
  switch (relation) {
    case Relation::kAbove:
      return value > limit;
    case Relation::kAtLeast:
      return value >= limit;
    case Relation::kBelow:
      return value < limit;
    case Relation::kAtMost:
      return value <= limit;
  }
  return false;
}

std::string_view SignOf(Relation relation) {
  constexpr std::string_view kSigns[] = {">", "\u2265", "<", "\u2264"};
  return kSigns[static_cast<std::size_t>(relation)];
}

std::string_view NameOf(Verdict verdict) {
  constexpr std::string_view kNames[] = {"holds", "holds in part", "refuted", "unstable"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::optional<Verdict> VerdictOf(const ClaimPart& part) {
  const auto holding = static_cast<std::size_t>(std::ranges::count_if(part.checks, &Check::Holds));
  return Joined(holding, part.checks.size() - holding, part.checks.size());
}

std::optional<Verdict> VerdictOf(std::span<const ClaimPart> parts) {
  std::size_t count = 0, holding = 0, refuted = 0, unasked = 0;
  for (const ClaimPart& part : parts) {
    const std::optional<Verdict> verdict = VerdictOf(part);
    ++count;
    if (!verdict) {
      ++unasked;
      continue;
    }
    holding += *verdict == Verdict::kHolds ? 1 : 0;
    refuted += *verdict == Verdict::kRefuted ? 1 : 0;
  }
  return unasked == count ? std::nullopt : Joined(holding, refuted, count);
}

Judgement Judge(std::span<const PartsAt> settings) {
  Judgement judgement;
  if (settings.empty()) return judgement;
  const std::vector<ClaimPart>& first = settings.front().parts;
  std::vector<Row> rows = RowsOf(settings);
  for (Row& row : rows) SortByPlace(row);
  for (std::size_t part = 0; part < first.size(); ++part) {
    const std::size_t before = judgement.turns.size();
    for (const Row& row : rows) AddTurns(row, part, judgement.turns);
    judgement.as_measured.push_back(VerdictOf(first[part]));
    judgement.parts.push_back(judgement.turns.size() > before ? Verdict::kUnstable
                                                              : judgement.as_measured.back());
  }
  judgement.reference = VerdictOf(first);
  judgement.verdict = judgement.turns.empty() ? judgement.reference : Verdict::kUnstable;
  return judgement;
}

}  // namespace stipple
