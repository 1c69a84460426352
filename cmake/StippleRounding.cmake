# Stops the configuration if the compiler drops roundings from double to float with the flags given: GCC 12 does at -O2
# without -fno-tree-slp-vectorize. Pictures would then depend on what the optimiser sees. A cross-compiler's program cannot
# be run here: that is said, and the test raytracer_test has to be run on the target.
function(stipple_check_rounding)
  set(key "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_CXX_FLAGS} ${ARGN}")
  if(STIPPLE_ROUNDING_CHECKED STREQUAL key)
    return()
  endif()
  if(CMAKE_CROSSCOMPILING)
    message(STATUS "Rounding from double to float: not checked, as programs for the target do not run here")
  else()
    # The check is made with optimisation whatever this build is, as flags come from the same place.
    string(JOIN " " CMAKE_CXX_FLAGS ${CMAKE_CXX_FLAGS} -O2 ${ARGN})
    try_run(status compiled ${PROJECT_BINARY_DIR}/CMakeFiles/rounding ${PROJECT_SOURCE_DIR}/cmake/rounding.cpp
      COMPILE_OUTPUT_VARIABLE output)
    if(NOT compiled)
      message(FATAL_ERROR "cmake/rounding.cpp does not compile:\n${output}")
    elseif(NOT status EQUAL 0)
      message(FATAL_ERROR "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} drops roundings from double to float with "
        "'${CMAKE_CXX_FLAGS}', so that the ray tracer's pictures would be wrong. Known of GCC 12's SLP vectoriser; "
        "-fno-tree-slp-vectorize helps.")
    endif()
    message(STATUS "Rounding from double to float: kept")
  endif()
  set(STIPPLE_ROUNDING_CHECKED "${key}" CACHE INTERNAL "compiler and flags for which stipple_check_rounding was content")
endfunction()
