// SPDX-License-Identifier: MIT
// The pages of a report, in one visible table. Each is a section that can be read alone.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_PAGES_H
#define STIPPLE_ANALYSIS_REPORT_HTML_PAGES_H

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/report_input.h"
#include "analysis/views/view_list.h"

namespace stipple {

/// Markup of a page below its heading; empty where it makes no sense: such a page is left out.
using PageFunction = std::string (*)(const ReportInput& input, const ViewInput& views);

struct PageEntry {
  std::string_view id;  // of the section: the address's end
  std::string_view title;
  PageFunction content;
};

std::span<const PageEntry> Pages();

/// A view of tables as a panel, with markup below it; empty where one of them has no rows.
std::string TablePanel(const ViewInput& views, const std::vector<Table>& tables, View view,
                       const std::string& heading, std::string_view id, const std::string& style,
                       const std::string& below = {});

ViewInput ViewsOf(const ReportInput& input);

std::string SummaryPage(const ReportInput& input, const ViewInput& views);
std::string NodesPage(const ReportInput& input, const ViewInput& views);
std::string CommunicationPage(const ReportInput& input, const ViewInput& views);
std::string FunctionsPage(const ReportInput& input, const ViewInput& views);
std::string TimePage(const ReportInput& input, const ViewInput& views);
std::string QualityPage(const ReportInput& input, const ViewInput& views);

}  // namespace stipple

#endif
