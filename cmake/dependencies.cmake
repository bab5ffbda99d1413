# The libraries simbench stands on: found here, brought by tools/setup, which says why each was chosen.
#
# Packages that cannot be installed beside a user's own lie unpacked under SIMBENCH_DEPS_DIR.
set(SIMBENCH_DEPS_DIR ${PROJECT_SOURCE_DIR}/build/deps CACHE PATH "Privately unpacked packages")
list(APPEND CMAKE_PREFIX_PATH ${SIMBENCH_DEPS_DIR}/usr)
if(SIMBENCH_PORTABLE)
  set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
if(SIMBENCH_PORTABLE)
  # Debian has fmt as a shared library alone.
  find_path(SIMBENCH_FMT_INCLUDE_DIR fmt/core.h REQUIRED NO_CACHE)
  add_library(fmt::fmt INTERFACE IMPORTED GLOBAL)
  target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)
  target_include_directories(fmt::fmt INTERFACE ${SIMBENCH_FMT_INCLUDE_DIR})
else()
  find_package(fmt 9 REQUIRED)
endif()

# Boost 1.81: Asio coroutines, Beast (HTTP of local pages), Random (same numbers with every compiler),
# Math. Headers only.
include(${CMAKE_CURRENT_LIST_DIR}/find_boost_headers.cmake)
simbench_find_boost_headers(1.81 HINTS ${SIMBENCH_DEPS_DIR}/usr/include)
if(NOT SIMBENCH_BOOST_INCLUDE_DIR)
  message(FATAL_ERROR "Boost 1.81 or newer: not found; run tools/setup")
endif()
add_library(simbench_boost INTERFACE)
set_target_properties(simbench_boost PROPERTIES EXPORT_NAME boost)
target_include_directories(simbench_boost SYSTEM INTERFACE
  $<BUILD_INTERFACE:${SIMBENCH_BOOST_INCLUDE_DIR}>)
target_link_libraries(simbench_boost INTERFACE Threads::Threads)

# libsodium 1.0.18: seals what goes between the hosts of a rig.
find_path(SIMBENCH_SODIUM_INCLUDE_DIR sodium.h HINTS ${SIMBENCH_DEPS_DIR}/usr/include NO_CACHE)
find_library(SIMBENCH_SODIUM_LIBRARY sodium HINTS ${SIMBENCH_DEPS_DIR}/usr/lib NO_CACHE)
if(NOT SIMBENCH_SODIUM_INCLUDE_DIR OR NOT SIMBENCH_SODIUM_LIBRARY)
  message(FATAL_ERROR "libsodium: not found; run tools/setup")
endif()
add_library(simbench_sodium INTERFACE)
set_target_properties(simbench_sodium PROPERTIES EXPORT_NAME sodium)
target_include_directories(simbench_sodium SYSTEM INTERFACE
  $<BUILD_INTERFACE:${SIMBENCH_SODIUM_INCLUDE_DIR}>)
target_link_libraries(simbench_sodium INTERFACE
  $<BUILD_INTERFACE:${SIMBENCH_SODIUM_LIBRARY}> $<INSTALL_INTERFACE:sodium>)

# uPlot 1.6: draws the figures of the HTML report, embedded in reports/. JavaScript, not linked.
find_path(SIMBENCH_UPLOT_DIR dist/uPlot.iife.min.js
  HINTS ${SIMBENCH_DEPS_DIR}/usr/share/javascript/uplot NO_CACHE NO_CMAKE_FIND_ROOT_PATH)
if(NOT SIMBENCH_UPLOT_DIR)
  message(FATAL_ERROR "uPlot: not found; run tools/setup")
endif()

# What files of others are written with: SQLite 3.40 (rosbag2), LZ4 1.9, zstd 1.5, bzip2 1.0, zlib
# 1.2. Used inside recording/ and bags/.
function(simbench_find_file_library name header)
  string(TOUPPER ${name} upper)
  find_path(SIMBENCH_${upper}_INCLUDE_DIR ${header} HINTS ${SIMBENCH_DEPS_DIR}/usr/include NO_CACHE)
  find_library(SIMBENCH_${upper}_LIBRARY ${name} HINTS ${SIMBENCH_DEPS_DIR}/usr/lib NO_CACHE)
  if(NOT SIMBENCH_${upper}_INCLUDE_DIR OR NOT SIMBENCH_${upper}_LIBRARY)
    message(FATAL_ERROR "${header}: not found; run tools/setup")
  endif()
  target_include_directories(simbench_file_libraries SYSTEM INTERFACE
    $<BUILD_INTERFACE:${SIMBENCH_${upper}_INCLUDE_DIR}>)
  target_link_libraries(simbench_file_libraries INTERFACE
    $<BUILD_INTERFACE:${SIMBENCH_${upper}_LIBRARY}> $<INSTALL_INTERFACE:${name}>)
endfunction()
add_library(simbench_file_libraries INTERFACE)
set_target_properties(simbench_file_libraries PROPERTIES EXPORT_NAME file_libraries)
simbench_find_file_library(sqlite3 sqlite3.h)
simbench_find_file_library(lz4 lz4frame.h)
simbench_find_file_library(zstd zstd.h)
simbench_find_file_library(bz2 bzlib.h)
simbench_find_file_library(z zlib.h)
