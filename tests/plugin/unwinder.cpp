// SPDX-License-Identifier: MIT
// A runtime, with the slow path of the real one, that records nothing: every event takes the slow
// path, and from within it the stack is unwound and compared with the visits that are open. At the
// end it prints `chains N wrong M`. The program's symbols must be dynamic (-rdynamic).
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unwind.h>

#include <cstdint>

#include "runtime/core/save_area.h"
#include "stipple/abi.h"

extern "C" {
void stipple_slow();
std::uint32_t stipple_slow_event(std::uint32_t token);
constinit stipple_control control{};  // no chunk: always slow
__thread stipple_control* stipple_stream __attribute__((tls_model("initial-exec"))) = &control;
// Of modes, which no slot here has.
std::uint32_t stipple_sample(std::uint32_t, std::uint64_t, std::uint64_t*) {
  return ~std::uint32_t{0};
}
std::uint32_t stipple_sample_leave(std::uint32_t) { return ~std::uint32_t{0}; }
}

namespace {

constexpr unsigned kMost = 256;
const char* regions[kMost];
unsigned region_count = 1;
const char* open_visits[kMost];
unsigned depth = 0;
unsigned chains = 0, wrong = 0;

/// The frames seen so far, innermost first, of which only the program's count.
struct Chain {
  const char* names[kMost];
  unsigned length;
  bool at_main;
};

_Unwind_Reason_Code Note(_Unwind_Context* context, void* data) {
  auto& chain = *static_cast<Chain*>(data);
  Dl_info info{};
  const auto address = static_cast<std::uintptr_t>(_Unwind_GetIP(context)) - 1;
  if (dladdr(reinterpret_cast<void*>(address), &info) == 0) return _URC_NO_REASON;
  const char* name = info.dli_sname;
  if (name == nullptr || strstr(info.dli_fname, "unwinder") != nullptr) return _URC_NO_REASON;
  if (chain.length < kMost) chain.names[chain.length++] = name;
  chain.at_main = strcmp(name, "main") == 0;
  return chain.at_main ? _URC_END_OF_STACK : _URC_NO_REASON;
}

void CompareStack() {
  Chain chain{};
  _Unwind_Backtrace(Note, &chain);
  bool same = chain.at_main && chain.length == depth;
  for (unsigned i = 0; same && i < depth; ++i)
    same = strcmp(chain.names[i], open_visits[depth - 1 - i]) == 0;
  ++chains;
  if (same) return;
  if (wrong++ > 0) return;
  printf("open:");
  for (unsigned i = depth; i-- > 0;) printf(" %s", open_visits[i]);
  printf("\nunwound:");
  for (unsigned i = 0; i < chain.length; ++i) printf(" %s", chain.names[i]);
  printf("\n");
}

__attribute__((destructor)) void Report() { printf("chains %u wrong %u\n", chains, wrong); }

}  // namespace

extern "C" __attribute__((visibility("hidden"))) std::uint32_t stipple_slow_event(
    std::uint32_t token) {
  const bool leave = (token & STIPPLE_LEAVE) != 0;
  if (!leave && depth < kMost) open_visits[depth++] = regions[token & STIPPLE_REGION_MASK];
  CompareStack();
  if (leave) --depth;
  return token;
}

extern "C" __attribute__((visibility("default"))) void stipple_register(stipple_dso* dso) {
  stipple::PrepareSaveArea();
  dso->slow = stipple_slow;
  dso->tp_offset =
      reinterpret_cast<char*>(&stipple_stream) - static_cast<char*>(__builtin_thread_pointer());
  for (stipple_descriptor* d = dso->begin; d != dso->end && region_count < kMost; ++d) {
    regions[region_count] = reinterpret_cast<const char*>(&d->name) + d->name;
    d->id = region_count++;
  }
}
extern "C" __attribute__((visibility("default"))) void stipple_unregister(stipple_dso*) {}
