# Short builds. Most of what a file costs to compile is its headers, so the files of a room are
# compiled together, behind headers that are compiled once.
#
# SIMBENCH_FAST_BUILD: off in the preset `clang`, which compiles every file by itself, so that a
# file that includes too little does not compile there.
option(SIMBENCH_FAST_BUILD "Compile the files of a room together, with precompiled headers" ON)

# What every folder uses. The project's own headers are not among them: an edit of one is not to
# compile everything. A header that makes code in each file that includes it (CLI11 does) costs more
# than it saves where it is not needed, so folders name their own beside these.
set(SIMBENCH_PRECOMPILED
  <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <deque> <filesystem> <fstream>
  <functional> <map> <memory> <optional> <set> <span> <stdexcept> <string> <string_view> <utility>
  <variant> <vector> <fmt/format.h> <fmt/ranges.h>)

# As many files of a room are one translation unit: an edit of one is compiled in seconds, and two
# cores share a folder.
set(SIMBENCH_UNIT_FILES 8)

# simbench_fast_build(TARGET SOURCES file... [PRECOMPILE header...])
function(simbench_fast_build target)
  cmake_parse_arguments(arg "" "" "SOURCES;PRECOMPILE" ${ARGN})
  if(NOT SIMBENCH_FAST_BUILD)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE ${SIMBENCH_PRECOMPILED} ${arg_PRECOMPILE})
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)

  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source ${arg_SOURCES})
    cmake_path(GET source PARENT_PATH room)
    file(RELATIVE_PATH room ${PROJECT_SOURCE_DIR} ${room})
    string(MAKE_C_IDENTIFIER ${room} room)
    math(EXPR ${room}_files "0${${room}_files} + 1")
    math(EXPR unit "(${${room}_files} - 1) / ${SIMBENCH_UNIT_FILES}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}_${unit})
  endforeach()
  # g++ takes the unnamed namespace of an included file for that of a header.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()
