// SPDX-License-Identifier: MIT
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr ViewEntry kViews[] = {
    {"timeline", TimelineView, "share of each state in each column of time, per rank"},
    {"bars", StateBarsView, "state shares of the whole run, per rank, with the mean"},
    {"waited-for", WaitedForView, "rank-seconds that others spent waiting for each rank"},
    {"utilisation", UtilisationView,
     "computing ranks over time: mean, least, most, since the start"},
    {"message-load", MessageLoadView, "bytes sent per second over time"},
    {"detail", DetailView, "a short period with its messages as lines"},
    {"matrix", MessageMatrixView, "messages from each rank to each other"},
    {"volume", VolumeMatrixView, "bytes from each rank to each other"}};

}  // namespace

std::span<const ViewEntry> Views() { return kViews; }

}  // namespace stipple
