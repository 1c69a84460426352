// SPDX-License-Identifier: MIT
#include "analysis/tools/terminal.h"

#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "analysis/tools/command.h"

namespace stipple {
namespace {

constexpr std::size_t kPlainWidth = 100;

volatile std::sig_atomic_t quit = 0;
volatile std::sig_atomic_t resized = 0;

void Catch(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;  // without SA_RESTART: a wait ends
  sigaction(signal, &action, nullptr);
}

std::string_view Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

Terminal::Terminal(bool plain)
    : plain_(plain || isatty(STDOUT_FILENO) == 0 || Environment("TERM") == "dumb" ||
             Environment("TERM").empty()) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) Catch(signal, [](int) { quit = 1; });
  if (plain_) return;
  Catch(SIGWINCH, [](int) { resized = 1; });
  has_keys_ = isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0;
  if (has_keys_) {
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // keys at once, and not shown
    tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  }
  WriteOut("\x1b[?1049h\x1b[?25l");  // the second screen, no cursor
}

Terminal::~Terminal() {
  if (!plain_) WriteOut("\x1b[?25h\x1b[?1049l");
  if (has_keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGWINCH}) Catch(signal, SIG_DFL);
}

WatchLook Terminal::Look() const {
  if (plain_) return {kPlainWidth, 0, WatchColours::kNone};
  winsize size = {};
  ioctl(STDOUT_FILENO, TIOCGWINSZ, &size);
  WatchLook look{80, 24, WatchColours::kPalette};
  if (size.ws_col > 0) look.width = size.ws_col;
  if (size.ws_row > 0) look.height = size.ws_row;
  const std::string_view depth = Environment("COLORTERM");
  if (!Environment("NO_COLOR").empty())
    look.colours = WatchColours::kNone;
  else if (depth == "truecolor" || depth == "24bit")
    look.colours = WatchColours::kTrue;
  return look;
}

void Terminal::Show(const std::vector<std::string>& lines) {
  std::string page = plain_ ? "" : "\x1b[H";  // from the top, over what is there: nothing flickers
  for (std::size_t i = 0; i < lines.size(); ++i) {
    page += lines[i];
    if (plain_)
      page += '\n';
    else
      page += i + 1 == lines.size() ? "\x1b[K" : "\x1b[K\r\n";
  }
  page += plain_ ? "\n" : "\x1b[J";
  WriteOut(page);
}

Terminal::Wake Terminal::Wait(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    if (quit != 0) return Wake::kQuit;
    if (resized != 0) {
      resized = 0;
      return Wake::kSize;
    }
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
    if (left <= 0) return Wake::kTime;
    // A signal just before the poll is seen at the next turn.
    const int milliseconds = static_cast<int>(std::ceil(std::min(left, 0.5) * 1e3));
    pollfd keys = {STDIN_FILENO, POLLIN, 0};
    if (poll(&keys, has_keys_ ? 1 : 0, milliseconds) <= 0 || (keys.revents & POLLIN) == 0) continue;
    char key = 0;
    if (read(STDIN_FILENO, &key, 1) == 1 && (key == 'q' || key == 'Q')) return Wake::kQuit;
    if (keys.revents & POLLHUP) has_keys_ = false;
  }
}

}  // namespace stipple
