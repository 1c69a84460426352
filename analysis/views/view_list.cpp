// SPDX-License-Identifier: MIT
#include "analysis/views/view_list.h"

#include "analysis/views/fits.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/series.h"

namespace stipple {
namespace {

constexpr ViewEntry kViews[] = {
    {"timeline", TimelineOrDetailView, nullptr, "", false,
     "each rank's state over time; zoomed in: messages and functions"},
    {"matrix", MatrixView, FitsMatrix, "messages,volume", false,
     "a number for each sender and receiver"},
    {"bars", BarsView, FitsBars, "states", false, "bars by rank or by name; states are stacked"},
    {"histogram", HistogramView, FitsHistogram, "sizes", false,
     "upright bars over classes of sizes, or over message types"},
    {"xy", XyView, FitsTime, "utilisation,load", false, "lines over time, above one another"},
    {"strip", StripView, FitsTime, "utilisation", true, "a small row over time for each rank"},
    {"kiviat", KiviatView, FitsRanks, "utilisation", true,
     "an axis for each rank, a closed line for each value"},
    {"dials", DialsView, FitsRanks, "utilisation", true, "a dial for each rank at a moment"},
    {"leds", LedsView, FitsRanks, "states", true, "a column of LEDs for each rank at a moment"},
    {"status", StatusView, FitsStatus, "status", false, "the state of each rank at a moment"},
    {"contour", ContourView, FitsRanksOverTime, "utilisation", true,
     "levels of a value over ranks and time"},
    {"flame", FlameView, FitsFlame, "callpaths", false,
     "call paths: as wide as their time, callers on top"},
    {"graph", GraphView, FitsGraph, "profile", false, "any column against any other, as points"}};

constexpr PanelEntry kPanels[] = {
    {"timeline", TimelineView},        {"bars", StateBarsView},
    {"waited-for", WaitedForView},     {"utilisation", UtilisationView},
    {"message-load", MessageLoadView}, {"detail", DetailView},
    {"matrix", MessageMatrixView},     {"volume", VolumeMatrixView}};

}  // namespace

std::span<const ViewEntry> Views() { return kViews; }
std::span<const PanelEntry> Panels() { return kPanels; }

}  // namespace stipple
