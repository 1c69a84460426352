// SPDX-License-Identifier: MIT
#include "runtime/unwind/unwind.h"

#define UNW_LOCAL_ONLY
#include <libunwind.h>

namespace {

// A stack that overflowed has some hundred thousand frames; a broken one may have no end.
constexpr size_t kEndless = 10'000'000;

}  // namespace

extern "C" {

size_t stipple_unwind_here(uintptr_t* frames, size_t most) {
  const int count = unw_backtrace(reinterpret_cast<void**>(frames), static_cast<int>(most));
  return count < 0 ? 0 : static_cast<size_t>(count);
}

size_t stipple_unwind_from(void* context, uintptr_t* frames, size_t most, size_t outer,
                           size_t* cut) {
  *cut = 0;
  unw_cursor_t cursor;
  if (unw_init_local2(&cursor, static_cast<unw_context_t*>(context), UNW_INIT_SIGNAL_FRAME) != 0)
    return 0;
  // The last `outer` places are a ring once the others are full.
  const size_t inner = most - outer;
  size_t count = 0;
  do {
    unw_word_t address = 0;
    if (unw_get_reg(&cursor, UNW_REG_IP, &address) != 0 || address == 0) break;
    frames[count < most ? count : inner + (count - inner) % outer] = address;
  } while (++count < kEndless && unw_step(&cursor) > 0);
  if (count <= most) return count;
  *cut = count - most;
  // Turn the ring so that it begins with its oldest frame: three reversals.
  const auto reverse = [frames](size_t begin, size_t end) {
    for (; begin + 1 < end; ++begin, --end) {
      const uintptr_t other = frames[begin];
      frames[begin] = frames[end - 1];
      frames[end - 1] = other;
    }
  };
  const size_t oldest = inner + (count - inner) % outer;
  reverse(inner, oldest);
  reverse(oldest, most);
  reverse(inner, most);
  return most;
}
}
