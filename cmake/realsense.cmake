# The adapter for RealSense cameras (hardware/realsense) and its tests: built where librealsense2 is
# found, left out elsewhere. Debian has no package of it; docs/rigs.md says how to get it, and
# -Drealsense2_DIR=<prefix>/lib/cmake/realsense2 finds one that was installed by hand. Nothing else
# needs it: recorded cameras stand in.
#
# SIMBENCH_WITH_REALSENSE: AUTO (where it is found), ON (an error where not), OFF.
set(SIMBENCH_WITH_REALSENSE AUTO CACHE STRING "Build the RealSense adapter: AUTO, ON or OFF")
set(SIMBENCH_REALSENSE_FOUND FALSE)
if(SIMBENCH_WITH_REALSENSE)
  set(required "")
  if(NOT SIMBENCH_WITH_REALSENSE STREQUAL "AUTO")
    set(required REQUIRED)
  endif()
  find_package(realsense2 ${required} QUIET CONFIG)
  set(SIMBENCH_REALSENSE_FOUND ${realsense2_FOUND})
endif()
if(SIMBENCH_REALSENSE_FOUND)
  message(STATUS "RealSense cameras: with librealsense2 ${realsense2_VERSION}")
else()
  message(STATUS "RealSense cameras: not built, no librealsense2")
endif()

foreach(target simbench_hardware hardware_test hardware_slow_test)
  if(NOT TARGET ${target})
    continue()
  elseif(SIMBENCH_REALSENSE_FOUND)
    target_link_libraries(${target} PRIVATE realsense2::realsense2)
    target_compile_definitions(${target} PRIVATE SIMBENCH_HAS_REALSENSE)
  else()
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources EXCLUDE REGEX "/hardware/realsense/[^/]+\\.cc$")
    set_target_properties(${target} PROPERTIES SOURCES "${sources}")
  endif()
endforeach()
