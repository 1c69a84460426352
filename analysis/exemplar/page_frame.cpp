// SPDX-License-Identifier: MIT
#include "analysis/exemplar/page_frame.h"

#include "analysis/report/html_style.h"
#include "analysis/views/svg_write.h"

namespace stipple {

std::string PageOf(std::string_view title, std::string_view lead, std::string_view style,
                   std::string_view sections) {
  const std::string heading = EscapeMarkup(title);
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>";
  page += heading + "</title>\n<style>" + PageStyle(false);
  page += style;
  page += "</style></head><body>\n<header><h1>" + heading + "</h1>\n<p class=\"facts\">" +
          EscapeMarkup(lead) + "</p></header><main>\n";
  page += sections;
  return page + "</main>\n</body></html>\n";
}

}  // namespace stipple
