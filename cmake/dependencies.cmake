# The libraries simbench stands on. tools/setup brings them; headers that cannot be installed beside
# a user's own packages lie under build/deps (see tools/setup).
set(SIMBENCH_DEPS_DIR ${PROJECT_SOURCE_DIR}/build/deps CACHE PATH "Privately unpacked packages")
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(fmt 9 REQUIRED)

find_path(SIMBENCH_BOOST_INCLUDE_DIR boost/asio/awaitable.hpp
  HINTS ${SIMBENCH_DEPS_DIR}/usr/include NO_CACHE)
find_path(SIMBENCH_VALIJSON_INCLUDE_DIR valijson/validator.hpp
  HINTS ${SIMBENCH_DEPS_DIR}/usr/include NO_CACHE)
foreach(dir SIMBENCH_BOOST_INCLUDE_DIR SIMBENCH_VALIJSON_INCLUDE_DIR)
  if(NOT ${dir})
    message(FATAL_ERROR "${dir}: not found; run tools/setup")
  endif()
endforeach()

# Boost 1.81: Asio coroutines, Random (same numbers with every compiler), Math. Headers only.
add_library(simbench_boost INTERFACE)
set_target_properties(simbench_boost PROPERTIES EXPORT_NAME boost)
target_include_directories(simbench_boost SYSTEM INTERFACE
  $<BUILD_INTERFACE:${SIMBENCH_BOOST_INCLUDE_DIR}>)
target_link_libraries(simbench_boost INTERFACE Threads::Threads)

# valijson 1.0: JSON Schema validation over nlohmann-json. Headers only, used inside scenarios/.
add_library(simbench_valijson INTERFACE)
target_include_directories(simbench_valijson SYSTEM INTERFACE
  $<BUILD_INTERFACE:${SIMBENCH_VALIJSON_INCLUDE_DIR}>)
