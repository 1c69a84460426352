// SPDX-License-Identifier: MIT
// Coroutines that hand over to one another: each hand-over is a jump, at any depth.
#include <coroutine>
#include <cstdio>
#include <cstdlib>

struct Task {
  struct promise_type {
    Task get_return_object() { return {std::coroutine_handle<promise_type>::from_promise(*this)}; }
    std::suspend_always initial_suspend() noexcept { return {}; }
    std::suspend_always final_suspend() noexcept { return {}; }
    void return_void() {}
    void unhandled_exception() {}
  };
  std::coroutine_handle<promise_type> handle;
};

std::coroutine_handle<> partners[2];
long left = 0;

struct HandOver {
  int to;
  bool await_ready() noexcept { return false; }
  std::coroutine_handle<> await_suspend(std::coroutine_handle<>) noexcept {
    return left-- > 0 ? partners[to] : std::noop_coroutine();
  }
  void await_resume() noexcept {}
};

Task Ping() {
  for (;;) co_await HandOver{1};
}

Task Pong() {
  for (;;) co_await HandOver{0};
}

int main(int argc, char** argv) {
  left = argc > 1 ? std::atol(argv[1]) : 3;
  Task ping = Ping(), pong = Pong();
  partners[0] = ping.handle;
  partners[1] = pong.handle;
  ping.handle.resume();
  std::printf("left %ld\n", left);
  ping.handle.destroy();
  pong.handle.destroy();
}
