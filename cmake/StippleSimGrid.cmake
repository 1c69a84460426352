# SimGrid, whose MPI (SMPI) runs the ray tracer on simulated machines. Without it all else is built.
#
# STIPPLE_SIMULATOR: whether it is there. Targets: stipple_simgrid (its library), stipple_smpi (that with its mpi.h).
find_path(STIPPLE_SMPI_INCLUDE mpi.h PATHS /usr/include/smpi NO_DEFAULT_PATH)
find_library(STIPPLE_SIMGRID_LIBRARY simgrid)
find_program(STIPPLE_SMPIMAIN smpimain PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/simgrid /usr/lib/simgrid NO_DEFAULT_PATH)
set(STIPPLE_SIMULATOR OFF)
if(STIPPLE_SMPI_INCLUDE AND STIPPLE_SIMGRID_LIBRARY AND STIPPLE_SMPIMAIN AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT STIPPLE_SANITIZE)
  set(STIPPLE_SIMULATOR ON)
  add_library(stipple_simgrid INTERFACE)
  target_link_libraries(stipple_simgrid INTERFACE ${STIPPLE_SIMGRID_LIBRARY})
  add_library(stipple_smpi INTERFACE)
  target_include_directories(stipple_smpi SYSTEM INTERFACE ${STIPPLE_SMPI_INCLUDE})
  target_link_libraries(stipple_smpi INTERFACE stipple_simgrid)
elseif(STIPPLE_SMPI_INCLUDE AND STIPPLE_SIMGRID_LIBRARY AND STIPPLE_SMPIMAIN)
  message(STATUS "stipple simulate is not built: it needs GCC and no sanitizers")
else()
  message(STATUS "stipple simulate is not built: no SimGrid (package libsimgrid-dev)")
endif()
