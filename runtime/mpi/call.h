// SPDX-License-Identifier: MIT
// One intercepted call: where the real function is, which region it is, and whether this visit to
// it is the program's own.
//
// The library defines PMPI_X with MPI_X as its alias, so that C, mpif.h, mpi and mpi_f08 programs
// all come here; the real PMPI_X is the next one. MPI itself calls PMPI_ functions too (its file
// layer does), and those are not events: only the outermost call of a thread is.
#ifndef STIPPLE_RUNTIME_MPI_CALL_H
#define STIPPLE_RUNTIME_MPI_CALL_H

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <atomic>
#include <cstdint>

#include "runtime/core/flavour.h"
#include "runtime/core/recorder.h"
#include "runtime/core/simulator.h"
#include "runtime/mpi/simulated.h"

// mpi.h may replace the names that MPI-3 removed by macros that refuse them.
#undef MPI_Address
#undef MPI_Errhandler_create
#undef MPI_Errhandler_get
#undef MPI_Errhandler_set
#undef MPI_Type_extent
#undef MPI_Type_hindexed
#undef MPI_Type_hvector
#undef MPI_Type_lb
#undef MPI_Type_struct
#undef MPI_Type_ub

namespace stipple::mpi {

/// One value per row of the table, silent ones included: their real functions are called from here.
enum class CallIndex : std::uint32_t {
#define STIPPLE_CALL(shape, name, parameters, arguments) k##name,
#define STIPPLE_COLLECTIVE(rule, name, parameters, arguments) k##name,
#define STIPPLE_ICOLLECTIVE(rule, name, parameters, arguments) k##name,
#define STIPPLE_REMOVED(name, parameters, arguments) k##name,
#define STIPPLE_BY_HAND(name) k##name,
#define STIPPLE_SILENT(name) k##name,
#include "runtime/mpi/calls.def"
#undef STIPPLE_CALL
#undef STIPPLE_COLLECTIVE
#undef STIPPLE_ICOLLECTIVE
#undef STIPPLE_REMOVED
#undef STIPPLE_BY_HAND
#undef STIPPLE_SILENT
  kCount
};

struct Call {
  const char* name;              // "PMPI_Send"
  std::atomic<void*> real;       // null until first used
  std::atomic<uint32_t> region;  // 0 until first recorded
};
extern Call calls[static_cast<std::uint32_t>(CallIndex::kCount)];

inline Call& CallOf(CallIndex index) { return calls[static_cast<std::uint32_t>(index)]; }

/// Address of a function of the MPI library that the process uses, not of its wrapper; null if
/// there is none.
void* FindFunction(const char* name);

/// Address of a variable of the MPI library, as the program sees it; null if there is none.
void* FindVariable(const char* name);

/// Looks the real function up and keeps it. Null if this MPI has no such function.
void* ResolveCall(Call& call);

template <class Function>
Function* Real(CallIndex index) {
  void* real = CallOf(index).real.load(std::memory_order_relaxed);
  if (real == nullptr) [[unlikely]] {
    real = ResolveCall(CallOf(index));
  }
  return reinterpret_cast<Function*>(real);
}

/// The MPI library's own PMPI_name; never the wrapper. The classic way, for what is linked into the
/// program, is the linker's: the wrappers are MPI_name, the real ones have other names.
#ifdef STIPPLE_CLASSIC_PMPI
#define STIPPLE_REAL(name) (&PMPI_##name)
#define STIPPLE_WRAPPER(name) MPI_##name
#else
#define STIPPLE_REAL(name) \
  (::stipple::mpi::Real<decltype(PMPI_##name)>(::stipple::mpi::CallIndex::k##name))
#define STIPPLE_WRAPPER(name) PMPI_##name
#endif

/// Whether the process uses the MPI that this library was compiled for. Another one has other
/// handles; its calls are handed on untouched.
bool KnownMpi();

/// Region of a call, defined at first use. 0: not recorded.
uint32_t DefineCall(Call& call);

/// Stack address of the outermost wrapper that this thread is in; 0 outside MPI. An address and not
/// a depth: a wrapper left by longjmp or an exception from an error handler never counts down, but
/// the next call then comes from a frame above it.
extern STIPPLE_PER_THREAD std::uintptr_t outermost_frame;

/// One visit of the program to an MPI function: enter now, leave by Leave().
class Visit {
 public:
  explicit Visit(CallIndex index) noexcept {
    const auto frame = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    if (outermost_frame != 0 && frame < outermost_frame) return;
    if constexpr (kSimulated) SettleCharges();
    region_ = CallOf(index).region.load(std::memory_order_relaxed);
    if (region_ == 0) [[unlikely]] {
      region_ = DefineCall(CallOf(index));
      if (region_ == 0) return;
    }
    outermost_frame = frame;
    enter_ticks_ = stipple_enter(region_);
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  bool Recorded() const { return region_ != 0; }
  uint32_t Region() const { return region_; }
  /// Full ticks of the enter event.
  std::uint64_t EnterTicks() const { return enter_ticks_; }

  void Leave() noexcept {
    if constexpr (kSimulated) RecordSystem(enter_ticks_);
    stipple_leave(region_);
    outermost_frame = 0;
  }

 private:
  uint32_t region_ = 0;
  std::uint64_t enter_ticks_ = 0;
};

/// Appends an event record; the core sets the header.
template <class Record>
void Append(const Record& record) noexcept {
  stipple_append(&record, static_cast<uint8_t>(Record::kKind), sizeof(Record));
}

}  // namespace stipple::mpi

#ifndef STIPPLE_CLASSIC_PMPI
extern "C" {
// What mpi.h no longer declares.
#define STIPPLE_CALL(shape, name, parameters, arguments)
#define STIPPLE_COLLECTIVE(rule, name, parameters, arguments)
#define STIPPLE_ICOLLECTIVE(rule, name, parameters, arguments)
#define STIPPLE_REMOVED(name, parameters, arguments) int PMPI_##name parameters;
#define STIPPLE_BY_HAND(name)
#define STIPPLE_SILENT(name)
#include "runtime/mpi/calls.def"
#undef STIPPLE_CALL
#undef STIPPLE_COLLECTIVE
#undef STIPPLE_ICOLLECTIVE
#undef STIPPLE_REMOVED
#undef STIPPLE_BY_HAND
#undef STIPPLE_SILENT
}
#endif

#endif
