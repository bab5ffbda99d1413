# simbench_folder_library(NAME [RUNS_ONCE] [PARSES] [UNIT_FILES n] [PRECOMPILE header...]
#                         [LINK target...] [FIRST path... FIRST_LINK target...])
#
# Makes the static library simbench_NAME from every .cc file below the calling folder, links it
# publicly to the given targets, lets includes be written from the root of the project, and installs
# it with its headers.
#
# RUNS_ONCE: code in which no run spends its time. It is optimised a little in Release, and not at
# all under the sanitizers, which find no less in it.
# PARSES: code that fuzzers watch.
# UNIT_FILES: as in cmake/fast_build.cmake, where files take long; not under the sanitizers.
# PRECOMPILE: headers that most files of the folder include (cmake/fast_build.cmake has the rest).
# FIRST: beginnings of the paths, in the folder, of what a first table needs. These files are a library
# of their own, simbench_NAME_first, with which simbench_NAME is linked: tools/run builds those before
# the rest. FIRST_LINK: its targets.
function(simbench_folder_library name)
  cmake_parse_arguments(arg "RUNS_ONCE;PARSES" "UNIT_FILES" "PRECOMPILE;LINK;FIRST;FIRST_LINK" ${ARGN})
  set(flags "")
  foreach(flag RUNS_ONCE PARSES)
    if(arg_${flag})
      list(APPEND flags ${flag})
    endif()
  endforeach()
  if(arg_UNIT_FILES)
    list(APPEND flags UNIT_FILES ${arg_UNIT_FILES})
  endif()
  list(APPEND flags PRECOMPILE ${arg_PRECOMPILE})

  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  list(FILTER sources EXCLUDE REGEX "/main\\.cc$")
  if(arg_FIRST)
    list(JOIN arg_FIRST "|" beginnings)
    set(first ${sources})
    list(FILTER first INCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/(${beginnings})")
    list(REMOVE_ITEM sources ${first})
    simbench_static_library(${name}_first ${flags} LINK ${arg_FIRST_LINK} SOURCES ${first})
    list(APPEND arg_LINK simbench_${name}_first)
  endif()
  simbench_static_library(${name} ${flags} LINK ${arg_LINK} SOURCES ${sources})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/simbench
          COMPONENT development FILES_MATCHING PATTERN "*.h")
endfunction()

# The library simbench_NAME of these SOURCES; the rest is as above.
function(simbench_static_library name)
  cmake_parse_arguments(arg "RUNS_ONCE;PARSES" "UNIT_FILES" "PRECOMPILE;LINK;SOURCES" ${ARGN})
  add_library(simbench_${name} STATIC ${arg_SOURCES})
  add_library(simbench::${name} ALIAS simbench_${name})
  set_target_properties(simbench_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(simbench_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/simbench>)
  target_link_libraries(simbench_${name} PUBLIC simbench_flags ${arg_LINK})
  set(options "")
  if(arg_RUNS_ONCE AND SIMBENCH_SANITIZE)
    list(APPEND options -O0)
  elseif(arg_RUNS_ONCE AND CMAKE_BUILD_TYPE STREQUAL "Release")
    list(APPEND options -O1)
  endif()
  if(SIMBENCH_BUILD_FUZZ AND arg_PARSES)
    list(APPEND options -fsanitize=fuzzer-no-link)
  endif()
  set(unit_files "")
  if(arg_UNIT_FILES AND NOT SIMBENCH_SANITIZE)
    set(unit_files UNIT_FILES ${arg_UNIT_FILES})
  endif()
  simbench_fast_build(simbench_${name} ${unit_files} PRECOMPILE ${arg_PRECOMPILE} OPTIONS ${options})
  install(TARGETS simbench_${name} EXPORT simbench COMPONENT development)
endfunction()
