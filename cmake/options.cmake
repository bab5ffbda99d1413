# What every target of the project is built with.
include(GNUInstallDirs)

option(SIMBENCH_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(SIMBENCH_BUILD_BENCH "Build the benchmark programs" ${PROJECT_IS_TOP_LEVEL})
option(SIMBENCH_BUILD_PYTHON "Build the Python package (tools/setup --with-python)" OFF)
option(SIMBENCH_BUILD_FUZZ "Build the fuzzers, which need clang's libFuzzer (preset asan)" OFF)
set(SIMBENCH_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize= (empty: none)")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
# An installed program finds a library that lies outside the system's folders (build/deps).
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)

add_library(simbench_flags INTERFACE)
set_target_properties(simbench_flags PROPERTIES EXPORT_NAME flags)
target_compile_features(simbench_flags INTERFACE cxx_std_20)
# Results must depend neither on the compiler nor on the processor, for users of the library too: a
# fused multiply-add rounds once where two operations round twice; Eigen's vectors add in another
# order, and multiply and add at once, on arm64 (layouts stay those of a vectorised Eigen).
# cmake/elementary.cmake has the rest.
target_compile_options(simbench_flags INTERFACE -ffp-contract=off)
target_compile_definitions(simbench_flags INTERFACE
  EIGEN_DONT_VECTORIZE EIGEN_MAX_STATIC_ALIGN_BYTES=16)

# The rest is for building the project only.
function(simbench_build_options)
  foreach(option ${ARGN})
    target_compile_options(simbench_flags INTERFACE $<BUILD_INTERFACE:${option}>)
  endforeach()
endfunction()

# g++ collects its garbage from a GB on, not from 128 MB: a tenth of the time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  simbench_build_options(--param=ggc-min-heapsize=1000000)
  # Nobody replaces a function of a library at run time, as position-independent code would allow.
  simbench_build_options(-fno-semantic-interposition)
endif()
# A char has a sign on amd64 and none on arm64.
simbench_build_options(-fsigned-char)
# The libraries go into programs and into the Python module. Not CMake's property, which has -fPIE
# for programs: these would then need precompiled headers of their own.
simbench_build_options(-fPIC)
simbench_build_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(NOT CMAKE_BUILD_TYPE STREQUAL "Release")
  target_compile_definitions(simbench_flags INTERFACE $<BUILD_INTERFACE:_GLIBCXX_ASSERTIONS>)
endif()
if(SIMBENCH_SANITIZE)
  simbench_build_options(-fsanitize=${SIMBENCH_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(simbench_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${SIMBENCH_SANITIZE}>)
  # clang 14 cannot assemble its check of function types where there are coroutines.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND SIMBENCH_SANITIZE MATCHES "undefined")
    simbench_build_options(-fno-sanitize=function)
  endif()
endif()
