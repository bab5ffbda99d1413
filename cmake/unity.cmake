# Unity builds: several files in one translation unit, for builds that are only made to check. The
# headers are what most files cost to compile, and to read for clang-tidy.
#
# SIMBENCH_UNITY: tests are built so; with sanitizers the libraries are as well. What users run is
# never built so: a file that includes too little does not compile there, and an edit is one file.
option(SIMBENCH_UNITY "Compile tests (with sanitizers: all) several files at a time" OFF)

# simbench_unity(TARGET SOURCES file...)
#
# Compiles these sources of the target in groups of files that do not meet each other's local names.
function(simbench_unity target)
  cmake_parse_arguments(arg "" "" "SOURCES" ${ARGN})
  if(NOT SIMBENCH_UNITY OR NOT arg_SOURCES)
    return()
  endif()
  set(script ${PROJECT_SOURCE_DIR}/cmake/unity_groups.awk)
  execute_process(COMMAND awk -v size=10 -f ${script} ${arg_SOURCES}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" lines "${lines}")
  foreach(line ${lines})
    string(REGEX MATCH "^([0-9]+) (.*)$" line "${line}")
    set_source_files_properties(${CMAKE_MATCH_2} PROPERTIES UNITY_GROUP ${target}_${CMAKE_MATCH_1})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # g++ takes the unnamed namespace of an included file for that of a header.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  # What an edit adds may be another file's local name.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${arg_SOURCES} ${script})
endfunction()
