// SPDX-License-Identifier: MIT
#include <GL/glx.h>
#include <X11/Xlib.h>

#include <chrono>
#include <cstdlib>
#include <future>
#include <string>
#include <thread>
#include <utility>

#include "analysis/views/window/window.h"

namespace stipple {
namespace {

constexpr std::chrono::seconds kPatience(15);

std::string AskServer(const std::string& name) {
  Display* display = XOpenDisplay(name.c_str());
  if (display == nullptr) return "the X server at DISPLAY=" + name + " does not answer";
  int error = 0, event = 0;
  const bool has_glx = glXQueryExtension(display, &error, &event) != 0;
  // The connection stays: a server whose last client leaves begins anew, and the window's own
  // connection, opened at that moment, would be lost.
  [[maybe_unused]] static Display* const kKept = display;
  return has_glx ? "" : "the X server at DISPLAY=" + name + " cannot do OpenGL (no GLX)";
}

}  // namespace

std::string WhyNoDisplay() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') return "no display: DISPLAY is not set";
  // A server that takes the connection and says nothing would keep us forever.
  std::promise<std::string> promise;
  std::future<std::string> answer = promise.get_future();
  std::thread([name = std::string(name), promise = std::move(promise)]() mutable {
    promise.set_value(AskServer(name));
  }).detach();
  if (answer.wait_for(kPatience) != std::future_status::ready)
    return std::string("the X server at DISPLAY=") + name + " does not answer";
  return answer.get();
}

}  // namespace stipple
