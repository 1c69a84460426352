// SPDX-License-Identifier: MIT
// A C++20 coroutine: start and every resumption are visits of the same name.
#include <coroutine>
#include <cstdio>

struct Generator {
  struct promise_type {
    int value = 0;
    Generator get_return_object() {
      return {std::coroutine_handle<promise_type>::from_promise(*this)};
    }
    std::suspend_always initial_suspend() noexcept { return {}; }
    std::suspend_always final_suspend() noexcept { return {}; }
    std::suspend_always yield_value(int v) {
      value = v;
      return {};
    }
    void return_void() {}
    void unhandled_exception() {}
  };
  std::coroutine_handle<promise_type> handle;
};

[[gnu::noinline]] void Seen(int i) { std::printf("%d\n", i); }

Generator Count(int n) {
  for (int i = 0; i < n; ++i) co_yield i;
}

int main() {
  Generator g = Count(2);
  for (g.handle.resume(); !g.handle.done(); g.handle.resume()) Seen(g.handle.promise().value);
  g.handle.destroy();
}
