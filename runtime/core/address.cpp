// SPDX-License-Identifier: MIT
// From an address to a region. Compilers hand the hooks of -finstrument-functions nothing but the
// function's address, so a table leads from there to the id that an id slot would hold. It is read
// without a lock: an entry is complete before its address is stored, a table before the pointer to
// it; a full table is replaced by one twice as large and never given back, since somebody may be
// reading it.
//
// A library that is unloaded leaves its addresses to the next. While dlclose runs nobody reads the
// table: the pointer to it is null, every hook takes the lock and asks whether the module is still
// the one it was. After dlclose what went with the module is struck out.
//
// An exit is told nothing of its enter. One that belongs to an enter made while recording was
// switched off is known by a stack of these (skipped.h).
#include "runtime/core/address.h"

#include "runtime/core/clock.h"
#include "runtime/core/module.h"
#include "runtime/core/region.h"
#include "runtime/core/settings.h"
#include "runtime/core/skipped.h"
#include "runtime/core/stream.h"

namespace stipple {
namespace {

struct Function {
  std::atomic<std::uintptr_t> address;  // 0: an empty place
  std::atomic<std::uint32_t> token;     // what an id slot would hold; 0: off
  std::atomic<std::uint32_t> region;    // 0: to be looked up (again)
};
static_assert(sizeof(Function) == 16);

/// As many places as the mask says.
struct Table {
  std::uint64_t mask;
  std::uint64_t reserved;
  Function functions[1];
};

constexpr std::uint32_t kNever = ~std::uint32_t{0};  // a region: there is no id for this function

constinit std::atomic<Table*> readable{nullptr};
constinit Table* table = nullptr;  // under the lock
constinit std::uint64_t count = 0;

/// The place of `address`, or the empty place where it belongs.
Function& PlaceOf(Table& in, std::uintptr_t address) {
  // The upper bits of the product depend on all bits of the address.
  std::uint64_t at = (address * 0x9e3779b97f4a7c15u) >> 20;
  for (;; ++at) {
    Function& place = in.functions[at & in.mask];
    const std::uintptr_t there = place.address.load(std::memory_order_acquire);
    if (there == address || there == 0) return place;
  }
}

void Fill(Function& place, std::uintptr_t address, std::uint32_t token, std::uint32_t region) {
  place.token.store(token, std::memory_order_relaxed);
  place.region.store(region, std::memory_order_release);
  place.address.store(address, std::memory_order_release);
}

template <class Use>
void ForEachFunction(Use use) {
  for (std::uint64_t i = 0; table != nullptr && i <= table->mask; ++i)
    if (Function& f = table->functions[i]; f.address.load(std::memory_order_relaxed) != 0) use(f);
}

/// Room for one more; false without memory.
bool MakeRoom() {
  if (table != nullptr && count < table->mask / 2) return true;
  const std::uint64_t places = table == nullptr ? 256 : 2 * (table->mask + 1);
  auto* grown = static_cast<Table*>(MapMemory(sizeof(Table) + places * sizeof(Function)));
  if (grown == nullptr) return false;
  grown->mask = places - 1;
  ForEachFunction([grown](const Function& f) {
    const std::uintptr_t address = f.address.load(std::memory_order_relaxed);
    Fill(PlaceOf(*grown, address), address, f.token.load(std::memory_order_relaxed),
         f.region.load(std::memory_order_relaxed));
  });
  Table* old = readable.load(std::memory_order_relaxed);
  table = grown;
  if (old != nullptr) readable.store(grown, std::memory_order_release);
  return true;
}

void StrikeOut(const Module& module) {
  ForEachFunction([&module](Function& f) {
    const std::uintptr_t address = f.address.load(std::memory_order_relaxed);
    if (address < module.begin || address >= module.end) return;
    f.token.store(0, std::memory_order_relaxed);
    f.region.store(0, std::memory_order_release);
  });
}

/// Makes the table readable if no module is being unloaded; else looks after the one that holds
/// `address`. A child that was forked while one was unloaded comes here, too.
void Recheck(const Process& process, std::uintptr_t address) {
  if (process.unloading != 0) {
    Module* module = KnownModuleAt(address);
    if (module != nullptr && !StillMapped(*module)) StrikeOut(*module);
    return;
  }
  for (Module* m = Modules(); m != nullptr; m = m->next)
    if (m->mapped && !StillMapped(*m)) StrikeOut(*m);
  readable.store(table, std::memory_order_release);
}

struct Known {
  std::uint32_t token;
  std::uint32_t region;  // 0: nothing is known
};

/// Finds what is known of a function, or gives it a region.
[[gnu::noinline]] Known Learn(std::uintptr_t address) {
  if (ReadSettings().archive == nullptr || HasStopped()) return {0, 0};
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return {0, 0};
  Holding holding(process->lock);
  if (!MakeRoom()) return {0, 0};
  if (readable.load(std::memory_order_relaxed) == nullptr) Recheck(*process, address);
  Function& place = PlaceOf(*table, address);
  if (place.region.load(std::memory_order_relaxed) == 0) {
    const std::uint32_t region = CodeRegion(*process, ModuleAt(*process, address), address);
    if (place.address.load(std::memory_order_relaxed) == 0) ++count;
    Fill(place, address, TokenOf(region), region == 0 ? kNever : region);
  }
  return {place.token.load(std::memory_order_relaxed),
          place.region.load(std::memory_order_relaxed)};
}

inline Known Find(std::uintptr_t address) {
  if (Table* in = readable.load(std::memory_order_acquire)) {
    const Function& place = PlaceOf(*in, address);
    if (place.address.load(std::memory_order_relaxed) == address) {
      const std::uint32_t region = place.region.load(std::memory_order_acquire);
      if (region != 0) [[likely]]
        return {place.token.load(std::memory_order_relaxed), region};
    }
  }
  return Learn(address);
}

/// What instrumented code does inline (abi.h).
inline void Append(std::uint32_t token) {
  stipple_control& control = *stipple_stream;
  const std::uint64_t slot = Reserve(control, sizeof(EventWord));
  if (slot >= control.end) [[unlikely]] {
    stipple_slow_event(token, 0);  // no mode, so no sample
    return;
  }
  const std::uint64_t ticks = (slot & control.clock_mask) == 0 ? ReadTicks() : 0;
  std::atomic_ref<EventWord>(*reinterpret_cast<EventWord*>(slot))
      .store(ticks << kTimeShift | token, std::memory_order_release);
}

}  // namespace

void SilenceAddresses() {
  ForEachFunction([](Function& f) { f.token.store(0, std::memory_order_relaxed); });
}

void UpdateAddresses() {
  ForEachFunction([](Function& f) {
    const std::uint32_t region = f.region.load(std::memory_order_relaxed);
    if (region != kNever) f.token.store(TokenOf(region), std::memory_order_relaxed);
  });
}

void BeginUnload() {
  if (table == nullptr) return;
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return;
  Holding holding(process->lock);
  ++process->unloading;
  readable.store(nullptr, std::memory_order_seq_cst);
}

void EndUnload() {
  if (table == nullptr) return;
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return;
  Holding holding(process->lock);
  if (process->unloading != 0) --process->unloading;
  if (process->unloading == 0) Recheck(*process, 0);
}

}  // namespace stipple

extern "C" {

__attribute__((visibility("default"))) void __cyg_profile_func_enter(void* function, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(function);
  const stipple::Known known = stipple::Find(address);
  if (known.token != 0) [[likely]]
    stipple::Append(known.token);
  else if (known.region != 0 && known.region != stipple::kNever)
    stipple::NoteSkipped(address, __builtin_frame_address(0));
}

__attribute__((visibility("default"))) void __cyg_profile_func_exit(void* function, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(function);
  const stipple::Known known = stipple::Find(address);
  if (known.region == 0 || known.region == stipple::kNever) return;
  if (stipple::TakeSkipped(address, __builtin_frame_address(0))) return;
  if (known.token == 0 && stipple::HasStopped()) return;
  stipple::Append(known.region | STIPPLE_LEAVE);
}
}
