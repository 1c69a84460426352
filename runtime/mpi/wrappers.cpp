// SPDX-License-Identifier: MIT
// The wrappers: calls.def expanded by the shapes.
#include "runtime/mpi/shapes.h"

namespace stipple::mpi {

#define STIPPLE_CALL(shape, name, parameters, arguments) \
  STIPPLE_SHAPE_##shape(name, parameters, arguments)
#define STIPPLE_COLLECTIVE(rule, name, parameters, arguments) \
  STIPPLE_WRAP_COLLECTIVE(rule, name, parameters, arguments)
#define STIPPLE_ICOLLECTIVE(rule, name, parameters, arguments) \
  STIPPLE_WRAP_ICOLLECTIVE(rule, name, parameters, arguments)
#define STIPPLE_REMOVED(name, parameters, arguments) \
  STIPPLE_SHAPE_plain(name, parameters, arguments)
#define STIPPLE_BY_HAND(name)
#define STIPPLE_SILENT(name)
#include "runtime/mpi/calls.def"

#ifndef STIPPLE_CLASSIC_PMPI
// MPI defines no effect for Pcontrol: it is a message to a profiler, so its further arguments end
// here.
extern "C" STIPPLE_EXPORT int PMPI_Pcontrol(const int level, ...) {
  auto* const real = STIPPLE_REAL(Pcontrol);
  if (real == nullptr) [[unlikely]]
    return MPI_ERR_OTHER;
  Visit visit(CallIndex::kPcontrol);
  const int result = real(level);
  if (visit.Recorded()) visit.Leave();
  return result;
}
STIPPLE_ALIAS(Pcontrol)
#endif

}  // namespace stipple::mpi
