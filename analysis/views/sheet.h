// SPDX-License-Identifier: MIT
// A scene as a picture of its own: with its title, note and key, and a margin around it. On a page
// the page has these.
#ifndef STIPPLE_ANALYSIS_VIEWS_SHEET_H
#define STIPPLE_ANALYSIS_VIEWS_SHEET_H

#include "analysis/views/scene.h"

namespace stipple {

Scene OnSheet(Scene scene);

}  // namespace stipple

#endif
