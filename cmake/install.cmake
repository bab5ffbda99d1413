# Install and export. The component `program` is what tools/release packs: the command with all that
# belongs to it. The component `development`: the libraries with their headers, and the CMake package
# `simbench` (see cmake/simbench-config.cmake.in for how a user's project asks for it).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/simbench)
set(data_dir ${CMAKE_INSTALL_DATADIR}/simbench)

install(TARGETS simbench RUNTIME COMPONENT program)
install(DIRECTORY scenarios/ DESTINATION ${data_dir}/scenarios COMPONENT program
        FILES_MATCHING PATTERN "*.json")
install(DIRECTORY examples DESTINATION ${data_dir} COMPONENT program USE_SOURCE_PERMISSIONS)
install(DIRECTORY reports/baselines DESTINATION ${data_dir} COMPONENT program
        FILES_MATCHING PATTERN "*.json")
install(DIRECTORY reports/ci DESTINATION ${data_dir} COMPONENT program USE_SOURCE_PERMISSIONS)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES tools/systemd/simbench-node.service DESTINATION lib/systemd/system COMPONENT program)

# What is linked in, where it is linked in.
if(SIMBENCH_PORTABLE)
  set(materials_dir ${PROJECT_BINARY_DIR}/generated/materials)
  install(CODE "execute_process(
    COMMAND python3 ${PROJECT_SOURCE_DIR}/packaging/materials.py ${CMAKE_SYSTEM_PROCESSOR}
            ${PROJECT_VERSION} ${materials_dir} ${CMAKE_FIND_ROOT_PATH} ${SIMBENCH_DEPS_DIR} /
    COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
  install(DIRECTORY ${materials_dir}/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
endif()

# Man pages and shell completion, which the program itself prints; an emulator runs a foreign one.
if(NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR)
  set(shell_dir ${PROJECT_BINARY_DIR}/generated/shell)
  install(CODE "execute_process(
    COMMAND ${CMAKE_COMMAND} -D FOLDER=${shell_dir}
            \"-DPROGRAM=${CMAKE_CROSSCOMPILING_EMULATOR};$<TARGET_FILE:simbench>\"
            -P ${PROJECT_SOURCE_DIR}/cmake/shell_files.cmake COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT program)
  install(DIRECTORY ${shell_dir}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  install(FILES ${shell_dir}/simbench COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${shell_dir}/_simbench COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${shell_dir}/simbench.fish COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()

install(TARGETS simbench_flags simbench_elementary simbench_boost simbench_sodium
        simbench_file_libraries EXPORT simbench COMPONENT development)
install(EXPORT simbench NAMESPACE simbench:: FILE simbench-targets.cmake DESTINATION ${package_dir}
        COMPONENT development)
configure_package_config_file(cmake/simbench-config.cmake.in
  ${PROJECT_BINARY_DIR}/generated/simbench-config.cmake INSTALL_DESTINATION ${package_dir}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/simbench-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/generated/simbench-config.cmake
  ${PROJECT_BINARY_DIR}/generated/simbench-config-version.cmake
  cmake/find_boost_headers.cmake
  DESTINATION ${package_dir} COMPONENT development)
