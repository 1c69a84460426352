# Targets and functions that every part uses: warnings, sanitizers, instrumentation by the plugin of this tree, tests.

# Warnings are errors only where CMAKE_COMPILE_WARNING_AS_ERROR says so (presets dev and ci): users' compilers differ.
add_library(stipple_warnings INTERFACE)
target_compile_options(stipple_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wconversion>
  # At -O3 GCC 12 sees strings in moved variants as uninitialised and copies in `text + "x"` as overlapping.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-maybe-uninitialized -Wno-restrict>)

# For programs and libraries that run outside the traced process.
add_library(stipple_sanitize INTERFACE)
if(STIPPLE_SANITIZE)
  target_compile_options(stipple_sanitize INTERFACE -fsanitize=${STIPPLE_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(stipple_sanitize INTERFACE -fsanitize=${STIPPLE_SANITIZE})
endif()

# Compiles `target` with the plugin that this tree builds for the compiler in use; a change of the plugin rebuilds it.
# Without a plugin for that compiler the target is built uninstrumented, with a warning.
function(stipple_instrument target)
  get_target_property(sources ${target} SOURCES)
  foreach(language C CXX Fortran)
    if(NOT CMAKE_${language}_COMPILER_LOADED)
      continue()
    endif()
    set(compiler "${CMAKE_${language}_COMPILER_ID}")
    string(REGEX MATCH "^[0-9]+" major "${CMAKE_${language}_COMPILER_VERSION}")
    set(plugin "")
    if(compiler STREQUAL "GNU")
      set(plugin stipple_plugin_gcc)
      set(flags -fplugin=$<TARGET_FILE:${plugin}>)
    elseif(compiler STREQUAL "Clang")
      set(plugin stipple_plugin_llvm_${major})
      set(flags -fplugin=$<TARGET_FILE:${plugin}> -fpass-plugin=$<TARGET_FILE:${plugin}> -Rpass=stipple)
    endif()
    if(NOT TARGET "${plugin}")
      message(WARNING "no stipple plugin for ${compiler} ${major}: ${language} sources of ${target} are not instrumented")
      continue()
    endif()
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:${language}>:${flags}>")
    add_dependencies(${target} ${plugin})
    # OBJECT_DEPENDS takes no generator expression, so the file is named by where the plugin's target puts it.
    get_target_property(plugin_dir ${plugin} LIBRARY_OUTPUT_DIRECTORY)
    set_property(SOURCE ${sources} DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
      APPEND PROPERTY OBJECT_DEPENDS ${plugin_dir}/stipple.so)
  endforeach()
endfunction()

# For code that runs once: optimising it costs more than it brings.
add_library(stipple_cold INTERFACE)
target_compile_options(stipple_cold INTERFACE $<$<CONFIG:Release>:-O1>)

# stipple_test(NAME quick|full SOURCES ... LIBRARIES ...): a GoogleTest program, run as one CTest test.
function(stipple_test name label)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SOURCES;LIBRARIES")
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} stipple_warnings stipple_sanitize stipple_cold fmt::fmt GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM tests_precompiled)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${label})
endfunction()
