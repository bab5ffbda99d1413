# simbench_folder_library(NAME [LINK target...])
#
# Makes the static library simbench_NAME from every .cc file below the calling folder, links it
# publicly to the given targets, lets includes be written from the root of the project, and installs
# it with its headers.
function(simbench_folder_library name)
  cmake_parse_arguments(arg "" "" "LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  list(FILTER sources EXCLUDE REGEX "/main\\.cc$")
  add_library(simbench_${name} STATIC ${sources})
  add_library(simbench::${name} ALIAS simbench_${name})
  set_target_properties(simbench_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(simbench_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/simbench>)
  target_link_libraries(simbench_${name} PUBLIC simbench_flags ${arg_LINK})
  install(TARGETS simbench_${name} EXPORT simbench)
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/simbench
          FILES_MATCHING PATTERN "*.h")
endfunction()
