# simbench_folder_library(NAME [RUNS_ONCE] [PARSES] [PRECOMPILE header...] [LINK target...])
#
# Makes the static library simbench_NAME from every .cc file below the calling folder, links it
# publicly to the given targets, lets includes be written from the root of the project, and installs
# it with its headers.
#
# Two things shorten builds, without a word less being checked:
# - RUNS_ONCE: code that tests spend no time in is not optimised under the sanitizers, which find no
#   less in it.
# - PRECOMPILE: the headers that most files of the folder read, compiled once under the sanitizers.
#   Other builds do without, so that a file that includes too little does not compile there.
function(simbench_folder_library name)
  cmake_parse_arguments(arg "RUNS_ONCE;PARSES" "" "PRECOMPILE;LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  list(FILTER sources EXCLUDE REGEX "/main\\.cc$")
  add_library(simbench_${name} STATIC ${sources})
  add_library(simbench::${name} ALIAS simbench_${name})
  set_target_properties(simbench_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(simbench_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/simbench>)
  target_link_libraries(simbench_${name} PUBLIC simbench_flags ${arg_LINK})
  if(SIMBENCH_SANITIZE AND arg_PRECOMPILE)
    target_precompile_headers(simbench_${name} PRIVATE ${arg_PRECOMPILE})
  endif()
  if(SIMBENCH_SANITIZE)
    simbench_unity(simbench_${name} SOURCES ${sources})
  endif()
  if(SIMBENCH_SANITIZE AND arg_RUNS_ONCE)
    target_compile_options(simbench_${name} PRIVATE -O0)
  endif()
  if(SIMBENCH_BUILD_FUZZ AND arg_PARSES)
    target_compile_options(simbench_${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  install(TARGETS simbench_${name} EXPORT simbench)
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/simbench
          FILES_MATCHING PATTERN "*.h")
endfunction()
