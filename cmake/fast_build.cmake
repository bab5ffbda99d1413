# Short builds. Most of what a file costs to compile is its headers, so several files of a folder
# are compiled together (CMake's UNITY_BUILD), behind headers that are compiled once.
#
# SIMBENCH_FAST_BUILD: off in the preset `clang`, which compiles every file by itself, so that a
# file that includes too little does not compile there.
option(SIMBENCH_FAST_BUILD "Compile several files together, with precompiled headers" ON)

# What every folder uses. The project's own headers are not among them: an edit of one is not to
# compile everything. A header that makes code in each file that includes it (CLI11 does) costs more
# than it saves where it is not needed, so folders name their own beside these.
set(SIMBENCH_PRECOMPILED
  <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <deque> <filesystem> <fstream>
  <functional> <map> <memory> <optional> <set> <span> <stdexcept> <string> <string_view> <utility>
  <variant> <vector> <boost/asio/awaitable.hpp> <fmt/format.h> <fmt/ranges.h>)

# As many files are one translation unit: an edit of one is compiled in seconds, and two cores share
# a folder. The presets of the sanitizers have larger ones: nobody waits for an edit there, and
# clang-tidy reads once what all files of a unit include.
set(SIMBENCH_UNIT_FILES 8 CACHE STRING "Files that are compiled together, at most")

# simbench_fast_build(TARGET [UNIT_FILES n] [PRECOMPILE header...] [OPTIONS option...])
#
# UNIT_FILES: in place of SIMBENCH_UNIT_FILES. OPTIONS are the target's own compile options: targets
# that agree in these and in PRECOMPILE share one precompiled file.
function(simbench_fast_build target)
  cmake_parse_arguments(arg "" "UNIT_FILES" "PRECOMPILE;OPTIONS" ${ARGN})
  if(NOT arg_UNIT_FILES)
    set(arg_UNIT_FILES ${SIMBENCH_UNIT_FILES})
  endif()
  target_compile_options(${target} PRIVATE ${arg_OPTIONS})
  if(NOT SIMBENCH_FAST_BUILD)
    return()
  endif()
  simbench_precompiled(shared HEADERS ${arg_PRECOMPILE} OPTIONS ${arg_OPTIONS})
  target_precompile_headers(${target} REUSE_FROM ${shared})
  # fmt's definitions are the same where its precompiled headers are used.
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)
  set_target_properties(${target} PROPERTIES
    UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${arg_UNIT_FILES})
  # g++ takes the unnamed namespace of an included file for that of a header.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# The target, made when it is first asked for, that compiles the common headers and these with these
# options; its name goes to `result`.
function(simbench_precompiled result)
  cmake_parse_arguments(arg "" "" "HEADERS;OPTIONS" ${ARGN})
  string(MAKE_C_IDENTIFIER "precompiled_${arg_HEADERS}${arg_OPTIONS}" name)
  string(SHA1 name ${name})
  string(SUBSTRING ${name} 0 8 name)
  set(name simbench_precompiled_${name})
  set(${result} ${name} PARENT_SCOPE)
  if(TARGET ${name})
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/generated/precompiled.cc)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Compiled for its precompiled headers.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE simbench_flags simbench_boost CLI11::CLI11 fmt::fmt
    nlohmann_json::nlohmann_json $<TARGET_NAME_IF_EXISTS:GTest::gmock>)
  target_compile_options(${name} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${SIMBENCH_PRECOMPILED} ${arg_HEADERS})
endfunction()
