// SPDX-License-Identifier: MIT
// stipple watch: what a run does while it goes on. Each page is made of one reading of all that had
// been recorded until then, so it is exact; to stay cheap however long the run is, the pause before
// the next reading is at least nine times the processor time that the last one took.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include "analysis/report/watch_text.h"
#include "analysis/stats/tables.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/selection_options.h"
#include "analysis/tools/terminal.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

constexpr double kPauses = 9;      // in times of the last reading: a tenth of a core at most
constexpr double kConfirmS = 0.5;  // between two readings that find that nobody writes any more

/// What the user wants.
struct WatchOptions {
  std::string archive;
  double interval_s = 2;
  double window_s = 0;
  std::string table;
  bool once = false;
};

double CpuSeconds() {
  timespec t = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) / 1e9;
}

/// One reading and all that it stands on.
struct Page {
  Page(const WatchOptions& options, const WatchBefore& before)
      : trace(Trace::Open(options.archive)),
        analysis(trace),
        reading(analysis, WindowNs(options), before) {
    if (options.table.empty()) return;
    const auto entry = std::ranges::find(TableEntries(), options.table, &TableEntry::name);
    reading.table = entry->make(analysis, {}, {});
  }
  static std::int64_t WindowNs(const WatchOptions& options) {
    return std::llround((options.window_s > 0 ? options.window_s : options.interval_s) * 1e9);
  }
  bool IsRunning() const { return trace.header_health().Running(); }

  Trace trace;
  Analysis analysis;
  WatchReading reading;
};

/// Null: there is no archive yet, or nothing in it.
std::unique_ptr<Page> Read(const WatchOptions& options, const WatchBefore& before) {
  if (!std::filesystem::is_directory(options.archive)) return nullptr;
  try {
    auto page = std::make_unique<Page>(options, before);
    if (!page->trace.processes().empty()) return page;
  } catch (const InputError&) {
    // It was removed or renamed while it was looked at.
  }
  return nullptr;
}

class Watcher {
 public:
  explicit Watcher(const WatchOptions& options) : options_(options), terminal_(options.once) {}

  /// The last page; null: there never was one.
  std::unique_ptr<Page> Run() {
    for (;;) {
      const double begin_s = CpuSeconds();
      std::unique_ptr<Page> page = Read(options_, before_);
      if (page != nullptr) page_ = std::move(page);
      const bool ended = page_ != nullptr && !page_->IsRunning();
      if (options_.once || (ended && was_ended_)) return std::move(page_);
      was_ended_ = ended;
      pause_s_ = std::max(options_.interval_s, kPauses * (CpuSeconds() - begin_s));
      // Of a run that ended the caller shows the last page.
      if (!ended) Show();
      if (page_ != nullptr) before_ = {page_->reading.events, page_->trace.SpanNs()};
      if (!Pause(ended ? kConfirmS : pause_s_)) return std::move(page_);
    }
  }

 private:
  void Show() {
    if (page_ == nullptr) {
      const std::string text = fmt::format("waiting for {} ...", options_.archive);
      // In a file once is enough.
      if (!terminal_.is_plain() || !said_waiting_) terminal_.Show({text});
      said_waiting_ = true;
      return;
    }
    const WatchLook look = terminal_.Look();
    std::vector<std::string> lines = WatchLines(page_->reading, look);
    if (!terminal_.is_plain())
      lines.front() = lines.front().substr(0, look.width) + Hint(lines.front().size(), look.width);
    terminal_.Show(lines);
  }
  /// When the next page comes, if there is room for it behind the first line.
  std::string Hint(std::size_t used, std::size_t width) const {
    const std::string hint = fmt::format("every {:.3g} s, q quits", pause_s_);
    if (used + 2 + hint.size() > width) return "";
    return std::string(width - used - hint.size(), ' ') + hint;
  }
  /// False: somebody wants to quit.
  bool Pause(double seconds) {
    for (;;) {
      const Terminal::Wake wake = terminal_.Wait(seconds);
      if (wake != Terminal::Wake::kSize) return wake == Terminal::Wake::kTime;
      Show();
    }
  }

  const WatchOptions& options_;
  Terminal terminal_;
  std::unique_ptr<Page> page_;
  WatchBefore before_;
  double pause_s_ = 0;
  bool was_ended_ = false;
  bool said_waiting_ = false;
};

void CheckOptions(const WatchOptions& options) {
  if (!(options.interval_s > 0 && options.interval_s <= 86400))
    throw InputError("--interval", fmt::format("{} s is no pause", options.interval_s));
  if (!(options.window_s >= 0 && options.window_s <= 9e9))
    throw InputError("--window", fmt::format("{} s is no length of time", options.window_s));
  if (options.once && !std::filesystem::is_directory(options.archive))
    throw InputError(options.archive, "is not there");
  if (options.table.empty() ||
      std::ranges::find(TableEntries(), options.table, &TableEntry::name) != TableEntries().end())
    return;
  std::string known;
  for (const TableEntry& t : TableEntries()) known.append(" ").append(t.name);
  throw InputError("--table", "'" + options.table + "' is unknown; known:" + known);
}

}  // namespace

int RunWatch(const Arguments& arguments) {
  CommandOptions app("What a run does while it goes on.", "watch");
  WatchOptions options;
  app.Add({"A", "", "the archive; it need not be there yet", true}, options.archive);
  app.Add({"--interval", "S", "seconds between two pages; 2"}, options.interval_s);
  app.Add({"--window", "S", "seconds that count as lately; the interval"}, options.window_s);
  app.Add({"--table", "NAME", "show this table (of stipple stats)"}, options.table);
  app.Add({"--once", "", "one page as text, and stop"}, options.once);
  if (!app.Parse(arguments)) return 0;
  CheckOptions(options);
  std::unique_ptr<Page> last;
  {
    Watcher watcher(options);
    last = watcher.Run();
  }
  if (last == nullptr) return 0;
  // On the screen that stays; in a file only what is not there yet.
  if (isatty(STDOUT_FILENO) != 0 || options.once || !last->IsRunning())
    for (const std::string& line : WatchLines(last->reading, {})) WriteOut(line + "\n");
  WarnOfProblems(last->trace, last->analysis.health);
  return 0;
}

}  // namespace stipple
