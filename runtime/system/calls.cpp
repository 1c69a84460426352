// SPDX-License-Identifier: MIT
// Wrappers of libc's functions: calls.def expanded. A wrapper that records reads the clock twice
// and appends one record; what the program sees (result, errno, cancellation, EINTR, jumps out of
// signal handlers) is the real function's. Not recorded: what the runtime does itself, which is
// system calls without libc, and processes and threads that do not record.
#include <dlfcn.h>
#include <errno.h>
#include <sys/syscall.h>

#include "runtime/core/recorder.h"
#include "runtime/system/dispatch.h"
#include "runtime/system/record_call.h"
#include "runtime/system/ring.h"
#include "runtime/system/thread.h"

namespace stipple::system {
namespace {

enum class CallIndex : std::uint32_t {
#define STIPPLE_CALL(result, returns, symbol, number, parameters, arguments) k##symbol,
#define STIPPLE_PASS(returns, symbol, parameters, arguments) k##symbol,
#include "runtime/system/calls.def"
#undef STIPPLE_CALL
#undef STIPPLE_PASS
  kCount
};

struct Call {
  const char* symbol;
  std::uint32_t number;
  std::uint32_t kind;               // 0 to be found out, 1 named like the system call, 2 otherwise
  std::atomic<std::uint32_t> name;  // DefineName; 0: not yet, or not needed
  std::atomic<void*> real;
};
constinit Call calls[] = {
#define STIPPLE_CALL(result, returns, symbol, number, parameters, arguments) \
  {#symbol, number, 0, {0}, {nullptr}},
#define STIPPLE_PASS(returns, symbol, parameters, arguments) {#symbol, 0, 1, {0}, {nullptr}},
#include "runtime/system/calls.def"
#undef STIPPLE_CALL
#undef STIPPLE_PASS
};

/// libc has two of these; the plain look-up may find the one of before 2002.
void* Find(const char* symbol) {
  if (void* condition = dlvsym(RTLD_NEXT, symbol, "GLIBC_2.3.2")) return condition;
  return dlsym(RTLD_NEXT, symbol);
}

void* Real(Call& call) {
  void* real = call.real.load(std::memory_order_relaxed);
  if (real == nullptr) [[unlikely]] {
    real = Find(call.symbol);
    call.real.store(real, std::memory_order_relaxed);
  }
  return real;
}

__attribute__((constructor(101))) void FindAll() {
  for (Call& call : calls) Real(call);
}

bool IsSame(const char* a, const char* b) {
  while (*a != '\0' && *a == *b) ++a, ++b;
  return *a == *b;
}

/// Variants of one function are shown as the system call (open64, __read_chk); functions that only
/// rest on it by their own name.
bool IsNamedLikeKernel(const Call& call) {
  static constexpr const char* kOwnNames[] = {"usleep",
                                              "sleep",
                                              "send",
                                              "recv",
                                              "wait",
                                              "waitpid",
                                              "pthread_join",
                                              "sem_wait",
                                              "pthread_cond_wait",
                                              "pthread_cond_timedwait"};
  for (const char* name : kOwnNames)
    if (IsSame(call.symbol, name)) return false;
  return true;
}

/// The name's id for the record. Outside of any reservation.
std::uint32_t NameOf(Call& call) {
  if (call.kind == 0) call.kind = IsNamedLikeKernel(call) ? 1 : 2;
  if (call.kind == 1) return 0;
  std::uint32_t name = call.name.load(std::memory_order_relaxed);
  if (name == 0) {
    name = stipple_define_name(call.symbol, "");
    call.name.store(name, std::memory_order_relaxed);
  }
  return name;
}

/// One visit of the program to a wrapper.
class Visit {
 public:
  Visit() : thread_(ThisThread()) {
    records_ = wanted.calls != Calls::kNone && stipple_recording();
    if (thread_ != nullptr && thread_->dispatched) thread_->selector = kAllow;
    if (records_) enter_ticks_ = ReadTicks();
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  bool Records() const { return records_; }
  std::uint64_t EnterTicks() const { return enter_ticks_; }

  /// The last thing: it may be a new thread that has got its state by the record.
  void Leave() const {
    if (thread_ == nullptr) return;
    if (IsRingHalfFull(*thread_)) [[unlikely]]
      Draining(*thread_, ReadRing);
    if (thread_->dispatched) thread_->selector = kBlock;
  }

 private:
  KernelThread* thread_;
  bool records_;
  std::uint64_t enter_ticks_ = 0;
};

template <class T>
std::uint64_t Word(T value) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
}
template <class T>
std::uint64_t Word(T* pointer) {
  return reinterpret_cast<std::uint64_t>(pointer);
}

// How a result tells an error.
template <class T>
std::int64_t errno_Result(T result) {
  const auto value = static_cast<std::int64_t>(Word(result));
  return value == -1 ? -errno : value;
}
template <class T>
std::int64_t direct_Result(T result) {
  return -static_cast<std::int64_t>(result);
}

template <class... Arguments>
void Record(CallIndex index, const Visit& visit, std::int64_t result, Arguments... arguments) {
  Call& call = calls[static_cast<std::uint32_t>(index)];
  const std::uint64_t words[sizeof...(arguments) + 1] = {Word(arguments)..., 0};
  RecordCall(call.number, NameOf(call), visit.EnterTicks(), result, words, sizeof...(arguments));
}

// The order of a call: parameters behind what is known already.
#define STIPPLE_UNPACK(...) __VA_OPT__(, ) __VA_ARGS__

}  // namespace

namespace {

// A new thread has its ring from the begin, events or not. What it runs stands in one of a few
// places until it has taken it from there; without a free one the thread begins with its first
// event.
struct Start {
  std::atomic<std::uint32_t> taken;
  void* (*function)(void*);
  void* argument;
};
constinit Start starts[64] = {};

void* BeginThread(void* pointer) {
  Start& start = *static_cast<Start*>(pointer);
  auto* const function = start.function;
  void* const argument = start.argument;
  start.taken.store(0, std::memory_order_release);
  stipple_begin_thread();
  return function(argument);
}

Start* TakeStart(void* (*function)(void*), void* argument) {
  if (!stipple_recording() || (!wanted.switches && wanted.calls == Calls::kNone)) return nullptr;
  for (Start& start : starts) {
    if (start.taken.exchange(1, std::memory_order_acquire) != 0) continue;
    start.function = function;
    start.argument = argument;
    return &start;
  }
  return nullptr;
}

}  // namespace

// By its symbol's name, not by libc's declaration of it: those have other types, or attributes that
// say that a call never comes back by a cancellation. `record` is a statement about `visit` and
// `value`.
#define STIPPLE_WRAP(returns, symbol, parameters, arguments, record)                      \
  extern "C" __attribute__((visibility("default")))                                       \
  returns stipple_call_##symbol parameters __asm__(#symbol);                              \
  returns stipple_call_##symbol parameters {                                              \
    using Function = returns parameters;                                                  \
    auto* const real =                                                                    \
        reinterpret_cast<Function*>(Real(calls[static_cast<int>(CallIndex::k##symbol)])); \
    const Visit visit;                                                                    \
    returns const value = real arguments;                                                 \
    record;                                                                               \
    visit.Leave();                                                                        \
    return value;                                                                         \
  }
#define STIPPLE_CALL(result, returns, symbol, number, parameters, arguments) \
  STIPPLE_WRAP(returns, symbol, parameters, arguments,                       \
               if (visit.Records()) Record(CallIndex::k##symbol, visit,      \
                                           result##_Result(value) STIPPLE_UNPACK arguments))
#define STIPPLE_PASS(returns, symbol, parameters, arguments) \
  STIPPLE_WRAP(returns, symbol, parameters, arguments, (void)0)
#include "runtime/system/calls.def"
#undef STIPPLE_CALL
#undef STIPPLE_PASS
#undef STIPPLE_WRAP

// With the same promise as a STIPPLE_PASS row.
extern "C" __attribute__((visibility("default"))) int stipple_call_pthread_create(
    void* thread, const void* attributes, void* (*function)(void*),
    void* argument) __asm__("pthread_create");
int stipple_call_pthread_create(void* thread, const void* attributes, void* (*function)(void*),
                                void* argument) {
  using Function = int(void*, const void*, void* (*)(void*), void*);
  static constinit std::atomic<void*> real{nullptr};
  if (real.load(std::memory_order_relaxed) == nullptr)
    real.store(dlsym(RTLD_NEXT, "pthread_create"), std::memory_order_relaxed);
  auto* const create = reinterpret_cast<Function*>(real.load(std::memory_order_relaxed));
  const Visit visit;
  Start* start = TakeStart(function, argument);
  const int result = start == nullptr ? create(thread, attributes, function, argument)
                                      : create(thread, attributes, BeginThread, start);
  if (result != 0 && start != nullptr) start->taken.store(0, std::memory_order_release);
  visit.Leave();
  return result;
}

}  // namespace stipple::system
