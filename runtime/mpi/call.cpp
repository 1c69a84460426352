// SPDX-License-Identifier: MIT
#include "runtime/mpi/call.h"

#include <dlfcn.h>

#include "stipple/format.h"

namespace stipple::mpi {

Call calls[] = {
#define STIPPLE_CALL(shape, name, parameters, arguments) {"PMPI_" #name, {nullptr}, {0}},
#define STIPPLE_COLLECTIVE(rule, name, parameters, arguments) {"PMPI_" #name, {nullptr}, {0}},
#define STIPPLE_ICOLLECTIVE(rule, name, parameters, arguments) {"PMPI_" #name, {nullptr}, {0}},
#define STIPPLE_REMOVED(name, parameters, arguments) {"PMPI_" #name, {nullptr}, {0}},
#define STIPPLE_BY_HAND(name) {"PMPI_" #name, {nullptr}, {0}},
#define STIPPLE_SILENT(name) {"PMPI_" #name, {nullptr}, {0}},
#include "runtime/mpi/calls.def"
#undef STIPPLE_CALL
#undef STIPPLE_COLLECTIVE
#undef STIPPLE_ICOLLECTIVE
#undef STIPPLE_REMOVED
#undef STIPPLE_BY_HAND
#undef STIPPLE_SILENT
};

STIPPLE_PER_THREAD std::uintptr_t outermost_frame = 0;

namespace {

// An MPI library that came with a module loaded at run time (Python's, for one) is not in the
// global scope; its users still bind to this library first, which is.
void* FindInLibrary(const char* name) {
  void* library = dlopen("libmpi.so.40", RTLD_LAZY | RTLD_NOLOAD);
  if (library == nullptr) return nullptr;
  void* found = dlsym(library, name);
  dlclose(library);  // only the count that dlopen added
  return found;
}

}  // namespace

void* FindFunction(const char* name) {
  void* found = dlsym(RTLD_NEXT, name);
  return found != nullptr ? found : FindInLibrary(name);
}

// From the front of the scope: a program may hold the one copy of a library's variable that all use
// (a copy relocation), and the library's own is then never filled in.
void* FindVariable(const char* name) {
  void* found = dlsym(RTLD_DEFAULT, name);
  return found != nullptr ? found : FindInLibrary(name);
}

void* ResolveCall(Call& call) {
  void* real = FindFunction(call.name);
  call.real.store(real, std::memory_order_relaxed);
  return real;
}

bool KnownMpi() {
#ifdef STIPPLE_CLASSIC_PMPI
  return true;
#endif
  enum class Known : int { kUnasked, kYes, kNo };
  static constinit std::atomic<Known> known{Known::kUnasked};
  if (known.load(std::memory_order_relaxed) == Known::kUnasked) {
    known.store(FindVariable("ompi_mpi_comm_world") != nullptr ? Known::kYes : Known::kNo,
                std::memory_order_relaxed);
  }
  return known.load(std::memory_order_relaxed) == Known::kYes;
}

uint32_t DefineCall(Call& call) {
  if (!KnownMpi() || !stipple_begin()) return 0;
  const uint32_t region = stipple_define_region(call.name + 1, "", 0,  // without the P
                                                static_cast<uint32_t>(RegionKind::kMpi));
  call.region.store(region, std::memory_order_relaxed);
  return region;
}

}  // namespace stipple::mpi
