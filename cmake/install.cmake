# Install and export: the command, the libraries with their headers, the scenarios, and the CMake
# package `simbench` (see cmake/simbench-config.cmake.in for how a user's project asks for it).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/simbench)

install(TARGETS simbench RUNTIME)
install(TARGETS simbench_flags simbench_elementary simbench_boost simbench_sodium
  simbench_file_libraries EXPORT simbench)
install(EXPORT simbench NAMESPACE simbench:: FILE simbench-targets.cmake DESTINATION ${package_dir})
install(DIRECTORY scenarios/ DESTINATION ${CMAKE_INSTALL_DATADIR}/simbench/scenarios
        FILES_MATCHING PATTERN "*.json")
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES tools/systemd/simbench-node.service DESTINATION lib/systemd/system)

# Man pages and shell completion, which the program itself prints; a foreign one cannot be asked.
if(NOT CMAKE_CROSSCOMPILING)
  set(shell_dir ${PROJECT_BINARY_DIR}/generated/shell)
  install(CODE "execute_process(
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:simbench> -D FOLDER=${shell_dir}
            -P ${PROJECT_SOURCE_DIR}/cmake/shell_files.cmake COMMAND_ERROR_IS_FATAL ANY)")
  install(DIRECTORY ${shell_dir}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(FILES ${shell_dir}/simbench
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${shell_dir}/_simbench DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${shell_dir}/simbench.fish
          DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()

configure_package_config_file(cmake/simbench-config.cmake.in
  ${PROJECT_BINARY_DIR}/generated/simbench-config.cmake INSTALL_DESTINATION ${package_dir}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/simbench-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/generated/simbench-config.cmake
  ${PROJECT_BINARY_DIR}/generated/simbench-config-version.cmake
  cmake/find_boost_headers.cmake
  DESTINATION ${package_dir})
