# find_package(stipple) gives
#   stipple_instrument(target)   compiles the target's C, C++ and Fortran sources with the plugin for their compilers
#   stipple::headers             stipple/user.h, for marks and counters by hand
get_filename_component(stipple_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET stipple::headers)
  add_library(stipple::headers INTERFACE IMPORTED)
  target_include_directories(stipple::headers INTERFACE ${stipple_prefix}/include)
endif()

set(stipple_program ${stipple_prefix}/bin/stipple)

# Without a plugin for a compiler its sources are built uninstrumented, with a warning.
function(stipple_instrument target)
  target_link_libraries(${target} PRIVATE stipple::headers)
  foreach(language C CXX Fortran)
    if(NOT CMAKE_${language}_COMPILER_LOADED)
      continue()
    endif()
    execute_process(COMMAND ${stipple_program} flags ${CMAKE_${language}_COMPILER}
      OUTPUT_VARIABLE flags ERROR_VARIABLE problem RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT status EQUAL 0)
      message(WARNING "${language} sources of ${target} are not instrumented: ${problem}")
      continue()
    endif()
    separate_arguments(flags UNIX_COMMAND "${flags}")
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:${language}>:${flags}>")
  endforeach()
endfunction()
