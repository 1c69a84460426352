// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/text.h"
#include "analysis/views/window/curves_part.h"
#include "analysis/views/window/facts.h"
#include "analysis/views/window/shapes.h"

namespace stipple {
namespace {

constexpr std::size_t kWholeColumns = 1000;
constexpr std::size_t kMostCells = 400'000;
constexpr std::size_t kOverviewQuads = 1200;
constexpr double kMomentSteps = 4000;  // displays follow the cursor in steps of the run / this

Area OverviewPlot(const WindowLayout& layout) { return layout.overview; }

TimeAxis OverviewAxis(const Timeline& whole, const Area& area) {
  return {whole.begin_s, whole.end_s, area.left, area.right()};
}

}  // namespace

double AddTitle(Layer& layer, Point at, const std::string& title) {
  AddText(layer, at, title, {.size = 13, .colour = kInk, .bold = true});
  return at.x + TextWidth(title, 13, true) + 12;
}

WindowScene::WindowScene(const WindowSource& source) : source_(source) {
  const std::size_t ranks = std::max<std::size_t>(1, source.Ranks().size());
  whole_ = source.StatesIn(0, source.EndSeconds(),
                           std::clamp<std::size_t>(kMostCells / ranks, 100, kWholeColumns));
}

void WindowScene::SetFinding(Finding finding) {
  finding_ = std::move(finding);
  data_key_.clear();
}

void WindowScene::SetTables(DisplayTables tables) { tables_ = std::move(tables); }

void WindowScene::Resize(double width, double height) {
  width_ = width;
  height_ = height;
}

template <class Make>
void WindowScene::Refresh(Part part, std::string key, Make make) {
  ScenePart& of = parts_[part];
  if (of.version != 0 && of.key == key) return;
  of.layer = make();
  of.key = std::move(key);
  of.version = ++versions_;
}

void WindowScene::UpdateTimeline(const ViewState& state, bool moving) {
  const Area& area = layout_.timeline;
  const Effort effort = EffortFor(state.ranks().size(), area.width - 72, moving);
  std::string key =
      fmt::format("{} {} {} {} {} {} {}", state.visible().begin_s, state.visible().end_s, moving,
                  area.top, area.width, area.height, culprit());
  for (const int rank : state.ranks()) key += ' ' + std::to_string(rank);
  if (key == data_key_) return;
  data_ =
      AskTimeline(source_, state, effort, TimelinePart::RowsForVisits(state.ranks().size(), area),
                  moving ? &wide_visits_ : nullptr);
  timeline_ = TimelinePart(data_, area, culprit(), effort);
  data_key_ = std::move(key);
}

std::span<const ScenePart> WindowScene::Update(const ViewState& state, bool moving,
                                               std::optional<TimeSpan> band) {
  layout_ = LayOut(width_, height_, state);
  UpdateTimeline(state, moving);
  const std::string size = fmt::format("{} {} ", width_, height_);
  const std::string span = fmt::format("{} {} ", state.visible().begin_s, state.visible().end_s);
  Refresh(kHeader, size + (finding_ ? finding_->sentence : "-") + source_.Warning(),
          [&] { return HeaderLayer(state); });
  Refresh(kOverview, size, [&] { return OverviewLayer(); });
  Refresh(kOverviewFrame, size + span, [&] { return OverviewFrame(state); });
  Refresh(kRows, size + data_key_, [&] { return RowsLayer(state); });
  Refresh(kCurves,
          size + data_key_ + fmt::format(" {}", layout_.curves.size()) +
              (layout_.curves.empty() ? "" : std::string(NameOf(layout_.curves[0].panel))),
          [&] { return CurvesLayer(); });
  // Without a cursor they show the end of the view, which moves in each frame: they wait for rest.
  if (!moving || state.has_cursor() || parts_[kDisplays].version == 0)
    moment_ = MomentOfDisplays(state);
  std::string displays =
      size + fmt::format("{} {} {}", tables_.ready, moment_, static_cast<int>(state.statistic()));
  for (const PlacedPanel& panel : layout_.displays)
    displays += fmt::format(" {}", static_cast<int>(panel.panel));
  Refresh(kDisplays, displays, [&] { return DisplaysLayer(state); });
  std::string side = size + TitleOf(state, source_) + fmt::format("{}", state.speed());
  for (std::size_t p = 0; p < kPanelCount; ++p)
    side += state.Shows(static_cast<Panel>(p)) ? '1' : '0';
  side += std::to_string(static_cast<int>(state.statistic()));
  Refresh(kSide, side, [&] { return SideLayer(state); });
  ScenePart& overlay = parts_[kOverlay];
  overlay.layer = OverlayLayer(state, band);
  overlay.version = ++versions_;
  return parts_;
}

Layer WindowScene::HeaderLayer(const ViewState& /*state*/) const {
  Layer layer{"header", {}};
  const Area& area = layout_.header;
  const std::string sentence =
      finding_ ? finding_->sentence : "looking for what cost the time \u2026";
  AddText(layer, {area.left, 21}, ShortenEnd(sentence, area.width / 1.12, 18),
          {.size = 18, .colour = finding_ ? kInk : kSecondary, .bold = finding_.has_value()});
  std::string facts =
      fmt::format("{} \u00b7 {} \u00b7 {} \u00b7 {}", CleanUtf8(source_.Title()),
                  FormatCount(source_.Ranks().size(), "rank"), FormatSeconds(source_.EndSeconds()),
                  FormatCount(source_.EventCount(), "event"));
  const std::int64_t end_ns = std::llround(source_.EndSeconds() * 1e9);
  facts += " \u00b7 " + FormatCount(source_.MessageCount(0, end_ns), "message");
  AddText(layer, {area.left, 43}, ShortenEnd(facts, area.width, 12),
          {.size = 12, .colour = kSecondary});
  if (!source_.Warning().empty())
    AddText(layer, {area.left + TextWidth(facts, 12) + 16, 43}, source_.Warning(),
            {.size = 12, .colour = kAccent, .bold = true});
  return layer;
}

Layer WindowScene::OverviewLayer() const {
  Layer layer{"overview", {}};
  const Area area = OverviewPlot(layout_);
  const TimeAxis axis = OverviewAxis(whole_, area);
  RowGridLimits limits{.top = area.top,
                       .max_pitch = area.height,
                       .max_height = area.height,
                       .fill = 1,
                       .max_rows = 8};
  if (!whole_.rows.empty()) {
    Timeline ranks_only = whole_;
    for (TimelineRow& row : ranks_only.rows) row.is_host = false;  // no gap
    const RowGrid grid = MakeRowGrid(ranks_only.rows, -1, limits);
    layer =
        StateRects(MakeStateRuns(ranks_only, grid, axis.width() / 2, kOverviewQuads), grid, axis);
  }
  AddTimeAxis(layer, axis, area.bottom());
  return layer;
}

Layer WindowScene::OverviewFrame(const ViewState& state) const {
  Layer layer{"overview frame", {}};
  if (state.visible() == state.run()) return layer;
  const Area area = OverviewPlot(layout_);
  const TimeAxis axis = OverviewAxis(whole_, area);
  const double left = std::floor(axis.XOf(state.visible().begin_s)) + 0.5;
  const double right = std::max(left + 3, std::floor(axis.XOf(state.visible().end_s)) - 0.5);
  AddFrame(layer, {left, area.top - 2.5, right - left, area.height + 4}, kInk, 2);
  return layer;
}

Layer WindowScene::RowsLayer(const ViewState& state) const {
  Layer layer{"timeline", {}};
  const double y = layout_.timeline.top - kTitleHeight / 2;
  const double right = layout_.timeline.right();
  double x =
      AddTitle(layer, {layout_.timeline.left, y}, fmt::format("State of each {}", NounFor(whole_)));
  std::string note = data_.messages.empty() && data_.message_count > 0
                         ? FormatCount(data_.message_count, "message") + ", too many for lines"
                         : FormatCount(data_.message_count, "message");
  note = FormatSeconds(state.visible().length()) + " \u00b7 " + note;
  const double note_left = right - TextWidth(note, 12);
  for (const State s : {State::kUser, State::kSystem, State::kMessage, State::kIdle}) {
    const char* name = kStateNames[static_cast<std::size_t>(s)];
    const double end = x + 15 + TextWidth(name, 12);
    if (end + 16 > note_left) break;
    AddRect(layer, {x, y - 5, 10, 10}, ColourOf(s));
    AddText(layer, {x + 15, y}, name, {.size = 12, .colour = kInk});
    x = end + 14;
  }
  AddText(layer, {right, y}, note, {.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd});
  for (const Layer* of :
       {&timeline_.states, &timeline_.visits, &timeline_.visit_names, &timeline_.labels,
        &timeline_.axis_layer, &timeline_.messages, &timeline_.letters})
    layer.shapes.insert(layer.shapes.end(), of->shapes.begin(), of->shapes.end());
  return layer;
}

Layer WindowScene::CurvesLayer() const {
  Layer layer{"curves", {}};
  for (const PlacedPanel& placed : layout_.curves) {
    const Layer of = placed.panel == Panel::kUtilisation
                         ? UtilisationCurve(data_.states, whole_, timeline_.axis(), placed.area)
                         : LoadCurve(data_.states, timeline_.axis(), placed.area);
    layer.shapes.insert(layer.shapes.end(), of.shapes.begin(), of.shapes.end());
  }
  return layer;
}

double WindowScene::MomentOfDisplays(const ViewState& state) const {
  const double moment = state.has_cursor() ? state.cursor_s() : state.visible().end_s;
  if (!state.playing()) return moment;
  const double step = state.run().length() / kMomentSteps;
  return std::floor(moment / step) * step;
}

Layer WindowScene::DisplaysLayer(const ViewState& state) const {
  Layer layer{"displays", {}};
  for (const PlacedPanel& placed : layout_.displays) {
    const double y = placed.area.top - kTitleHeight / 2;
    std::string title(NameOf(placed.panel));
    title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
    const double x = AddTitle(layer, {placed.area.left, y}, title);
    const std::string note = placed.panel == Panel::kMatrix ? "messages so far"
                             : placed.panel == Panel::kStatus
                                 ? ""
                                 : std::string(NameOf(state.statistic()));
    const std::string fits = ShortenEnd(note, placed.area.right() - x, 12);
    AddText(layer, {x, y}, fits, {.size = 12, .colour = kSecondary});
    const Scene scene =
        DisplayScene(placed.panel, state.statistic(), tables_, source_, whole_, moment_);
    const Layer fitted = Fitted(scene, placed.area);
    layer.shapes.insert(layer.shapes.end(), fitted.shapes.begin(), fitted.shapes.end());
    if (fitted.shapes.empty())
      AddText(layer, {placed.area.left, placed.area.top + 14},
              tables_.ready ? "not recorded" : "counting \u2026",
              {.size = 12, .colour = kSecondary});
  }
  return layer;
}

Layer WindowScene::OverlayLayer(const ViewState& state, std::optional<TimeSpan> band) const {
  Layer layer{"overlay", {}};
  if (timeline_.grid().rows.empty()) return layer;
  const TimeAxis& axis = timeline_.axis();
  const double top = timeline_.grid().rows.front().y - 4;
  const double bottom = top + timeline_.grid().height + 8;
  if (state.picked) AddPicked(layer, *state.picked);
  if (band) {
    const double left = axis.XOf(std::min(band->begin_s, band->end_s));
    const double right = axis.XOf(std::max(band->begin_s, band->end_s));
    AddFrame(layer, {left, top, std::max(1.0, right - left), bottom - top}, kInk, 1.5);
    AddText(layer, {(left + right) / 2, top + 8},
            FormatSeconds(std::fabs(band->end_s - band->begin_s)),
            {.size = 12, .colour = kInk, .bold = true, .anchor = Anchor::kMiddle});
  }
  if (state.has_cursor()) {
    const Area overview = OverviewPlot(layout_);
    const double at = OverviewAxis(whole_, overview).XOf(state.cursor_s());
    AddLine(layer, {at, overview.top - 3}, {at, overview.bottom() + 3}, kInk, 1.5);
    if (state.visible().Has(state.cursor_s())) {
      const double x = axis.XOf(state.cursor_s());
      const double end = layout_.curves.empty() ? bottom : layout_.curves.back().area.bottom();
      AddLine(layer, {x, top}, {x, end}, kInk, 1.5);
      layer.shapes.emplace_back(
          PolygonShape{{{x - 5, top - 5}, {x + 5, top - 5}, {x, top + 2}}, kInk});
    }
  }
  if (state.help) {
    const Layer help = HelpLayer(layout_.width, layout_.height);
    layer.shapes.insert(layer.shapes.end(), help.shapes.begin(), help.shapes.end());
  }
  return layer;
}

void WindowScene::AddPicked(Layer& layer, const Picked& picked) const {
  const TimelinePart& t = timeline_;
  const auto row = std::ranges::find(data_.states.rows, picked.rank, &TimelineRow::rank);
  const auto index = static_cast<std::size_t>(row - data_.states.rows.begin());
  if (picked.visit && row != data_.states.rows.end())
    if (const auto area = t.AreaOf(index, *picked.visit)) AddFrame(layer, *area, kInk, 2);
  const TimeSpan span = SpanOf(picked);
  const auto grid_row = t.RowOfRank(picked.rank);
  if (grid_row && !picked.message && span.end_s >= data_.states.begin_s &&
      span.begin_s <= data_.states.end_s) {
    const GridRow& of = t.grid().rows[*grid_row];
    const double left = t.axis().XOf(span.begin_s), right = t.axis().XOf(span.end_s);
    AddFrame(layer, {left, of.y - 2, std::max(2.0, right - left), of.height + 4}, kInk, 1.5);
  }
  if (!picked.message) return;
  if (const auto line = t.LineOf(*picked.message)) {
    LineShape strong = *line;
    strong.stroke = kInk;
    strong.width = 2.5;
    strong.opacity = 1;
    layer.shapes.emplace_back(std::move(strong));
  }
  const auto mark_end = [&](int rank, double time_s, const char* letter) {
    const auto at = t.RowOfRank(rank);
    const double x = t.XOf(time_s);
    if (!at || x < t.axis().left || x > t.axis().right) return;
    const GridRow& of = t.grid().rows[*at];
    AddFrame(layer, {x - 1, of.y - 2, 2, of.height + 4}, kInk, 2);
    if (t.grid().pitch >= 24) return;  // the letter stands there already
    AddText(layer, {x + 8, of.y + of.height / 2}, letter,
            {.size = 11, .colour = kInk, .bold = true});
  };
  mark_end(picked.message->sender, static_cast<double>(picked.message->send_ns) * 1e-9, "s");
  mark_end(picked.message->receiver, static_cast<double>(picked.message->receive_ns) * 1e-9, "r");
}

double WindowScene::OverviewTime(double x) const {
  const Area area = OverviewPlot(layout_);
  return std::clamp((x - area.left) / area.width, 0.0, 1.0) * (whole_.end_s - whole_.begin_s) +
         whole_.begin_s;
}

WindowHit WindowScene::At(Point point) const {
  WindowHit hit;
  const Area overview{layout_.overview.left, layout_.overview.top - 4, layout_.overview.width,
                      layout_.overview.height + 24};
  if (overview.Has(point)) {
    hit.what = WindowHit::What::kOverview;
    hit.time_s = OverviewTime(point.x);
    return hit;
  }
  for (const auto& [area, panel] : menu_)
    if (area.Has(point)) {
      hit.what = WindowHit::What::kMenu;
      hit.panel = panel;
      return hit;
    }
  if (const auto timeline = timeline_.At(point)) {
    hit.what = WindowHit::What::kTimeline;
    hit.timeline = *timeline;
    hit.time_s = timeline->time_s;
    return hit;
  }
  const TimeAxis& axis = timeline_.axis();
  for (const PlacedPanel& curve : layout_.curves)
    if (curve.area.Has(point) && point.x >= axis.left) {
      hit.what = WindowHit::What::kCurve;
      hit.time_s =
          axis.begin_s + (point.x - axis.left) / axis.width() * (axis.end_s - axis.begin_s);
    }
  return hit;
}

}  // namespace stipple
