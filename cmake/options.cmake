# What every target of the project is built with.
include(GNUInstallDirs)

option(SIMBENCH_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(SIMBENCH_BUILD_BENCH "Build the benchmark programs" ${PROJECT_IS_TOP_LEVEL})
option(SIMBENCH_BUILD_FUZZ "Build the libFuzzer targets (clang only)" OFF)
set(SIMBENCH_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize= (empty: none)")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

add_library(simbench_flags INTERFACE)
set_target_properties(simbench_flags PROPERTIES EXPORT_NAME flags)
target_compile_features(simbench_flags INTERFACE cxx_std_20)
# Results must not depend on the compiler: a fused multiply-add rounds once where two operations
# round twice, so contraction stays off for users of the library too.
target_compile_options(simbench_flags INTERFACE -ffp-contract=off)
target_compile_options(simbench_flags INTERFACE
  $<BUILD_INTERFACE:-Wall> $<BUILD_INTERFACE:-Wextra> $<BUILD_INTERFACE:-Wpedantic>
  $<BUILD_INTERFACE:-Wshadow> $<BUILD_INTERFACE:-Wconversion> $<BUILD_INTERFACE:-Wno-sign-conversion>)
if(SIMBENCH_SANITIZE)
  target_compile_options(simbench_flags INTERFACE
    $<BUILD_INTERFACE:-fsanitize=${SIMBENCH_SANITIZE}>
    $<BUILD_INTERFACE:-fno-sanitize-recover=all> $<BUILD_INTERFACE:-fno-omit-frame-pointer>)
  target_link_options(simbench_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${SIMBENCH_SANITIZE}>)
endif()
