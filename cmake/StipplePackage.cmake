# What users find besides the programs: compiler wrappers, pkg-config's file, find_package's.
include(CMakePackageConfigHelpers)

file(MAKE_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
foreach(wrapper cc c++ fc mpicc mpicxx)
  install(PROGRAMS ${CMAKE_CURRENT_LIST_DIR}/stipple-cc DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME stipple-${wrapper})
  file(CREATE_LINK ${CMAKE_CURRENT_LIST_DIR}/stipple-cc ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/stipple-${wrapper} SYMBOLIC)
endforeach()

# pkg-config cannot ask a compiler for its version, so each plugin's flags are a variable of their own.
get_property(folders GLOBAL PROPERTY STIPPLE_PLUGIN_FOLDERS)
set(stipple_flags_by_compiler)
foreach(folder IN LISTS folders)
  string(REPLACE "-" "_" name ${folder})
  set(flags "-fplugin=\${plugin_dir}/${folder}/stipple.so")
  if(folder MATCHES "^llvm")
    string(APPEND flags " -fpass-plugin=\${plugin_dir}/${folder}/stipple.so -Rpass=stipple -Wno-unused-command-line-argument")
  endif()
  string(APPEND stipple_flags_by_compiler "${name}_flags=${flags}\n")
endforeach()
string(REPLACE ";" " " stipple_compilers "${folders}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/stipple.pc.in ${PROJECT_BINARY_DIR}/stipple.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/stipple.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

write_basic_package_version_file(${PROJECT_BINARY_DIR}/stippleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/stippleConfig.cmake ${PROJECT_BINARY_DIR}/stippleConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/stipple)
