# find_package(stipple) gives
#   stipple::instrument          link a target to it and its C, C++ and Fortran sources are compiled with the plugin for
#                                their compiler; a language that is enabled and has none is an error here
#   stipple_instrument(target)   the same as a function
#   stipple::static_runtime      for targets that are linked with -static: puts the runtime in
#   stipple::headers             stipple/user.h, for regions, marks and counters by hand
#   stipple::fortran             the same as a Fortran module, if the project has Fortran
# find_package(stipple COMPONENTS headers) gives the last two alone, whatever the compilers.
get_filename_component(stipple_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET stipple::headers)
  add_library(stipple::headers INTERFACE IMPORTED)
  target_include_directories(stipple::headers INTERFACE ${stipple_prefix}/include)
endif()
if(CMAKE_Fortran_COMPILER_LOADED AND NOT TARGET stipple::fortran)
  # Compiled here, once for the project: module files fit one compiler only.
  add_library(stipple_fortran STATIC EXCLUDE_FROM_ALL ${stipple_prefix}/include/stipple/stipple.f90)
  set_target_properties(stipple_fortran PROPERTIES POSITION_INDEPENDENT_CODE ON
    Fortran_MODULE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/stipple_fortran)
  target_include_directories(stipple_fortran INTERFACE ${CMAKE_CURRENT_BINARY_DIR}/stipple_fortran)
  add_library(stipple::fortran ALIAS stipple_fortran)
endif()
if("${stipple_FIND_COMPONENTS}" STREQUAL "headers" OR TARGET stipple::instrument)
  return()
endif()

# A row per plugin: GCC takes its folder's name (gcc-12), clang is LLVM's (llvm-14).
file(GLOB stipple_plugins ${stipple_prefix}/lib/stipple/*/stipple.so)
add_library(stipple::instrument INTERFACE IMPORTED)
target_link_libraries(stipple::instrument INTERFACE stipple::headers)
set(stipple_known)
foreach(plugin IN LISTS stipple_plugins)
  get_filename_component(folder ${plugin} DIRECTORY)
  get_filename_component(folder ${folder} NAME)
  if(NOT folder MATCHES "^(gcc|llvm)-([0-9]+)$")
    continue()
  endif()
  list(APPEND stipple_known ${folder})
  set(major ${CMAKE_MATCH_2})
  math(EXPR next "${major} + 1")
  if(CMAKE_MATCH_1 STREQUAL "gcc")
    set(id GNU)
    set(flags -fplugin=${plugin})
  else()
    set(id Clang)
    set(flags -fplugin=${plugin} -fpass-plugin=${plugin} -Rpass=stipple -Wno-unused-command-line-argument)
  endif()
  foreach(language C CXX Fortran)
    set(version "$<${language}_COMPILER_VERSION>")
    set(fits "$<VERSION_GREATER_EQUAL:${version},${major}>,$<VERSION_LESS:${version},${next}>")
    target_compile_options(stipple::instrument INTERFACE
      "$<$<AND:$<COMPILE_LANG_AND_ID:${language},${id}>,${fits}>:${flags}>")
    if(id STREQUAL "GNU")  # with -flto functions are compiled, and instrumented, when linking
      target_link_options(stipple::instrument INTERFACE "$<$<AND:$<LINK_LANG_AND_ID:${language},${id}>,${fits}>:${flags}>")
    endif()
  endforeach()
endforeach()

foreach(language C CXX Fortran)
  if(NOT CMAKE_${language}_COMPILER_LOADED)
    continue()
  endif()
  string(REGEX MATCH "^[0-9]+" major "${CMAKE_${language}_COMPILER_VERSION}")
  string(REPLACE "Clang" "llvm" folder "${CMAKE_${language}_COMPILER_ID}-${major}")
  string(REPLACE "GNU" "gcc" folder "${folder}")
  if(NOT folder IN_LIST stipple_known)
    list(JOIN stipple_known " " known)
    message(FATAL_ERROR "stipple has no plugin for the ${language} compiler, ${CMAKE_${language}_COMPILER_ID} "
      "${CMAKE_${language}_COMPILER_VERSION}; there are plugins for: ${known}")
  endif()
endforeach()

add_library(stipple::static_runtime INTERFACE IMPORTED)
target_link_options(stipple::static_runtime INTERFACE -Wl,-u,stipple_register,-u,stipple_record_mark)
target_link_libraries(stipple::static_runtime INTERFACE ${stipple_prefix}/lib/stipple/libstipple.a)

function(stipple_instrument target)
  target_link_libraries(${target} PRIVATE stipple::instrument)
endfunction()
