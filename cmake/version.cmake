# Gives simbench_recording the values behind recording/version.h.
#
# Every build asks Git for the commit (some 20 ms) and writes generated/version.cc only when the
# answer has changed, so that a new commit compiles this one file and links.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(SIMBENCH_VERSION_SOURCE ${PROJECT_BINARY_DIR}/generated/version.cc)
  add_custom_target(simbench_version
    COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${PROJECT_SOURCE_DIR} -D VERSION=${PROJECT_VERSION}
            -D OUTPUT=${SIMBENCH_VERSION_SOURCE} -P ${CMAKE_CURRENT_LIST_FILE}
    BYPRODUCTS ${SIMBENCH_VERSION_SOURCE}
    COMMENT "Reading the commit")
  target_sources(simbench_recording PRIVATE ${SIMBENCH_VERSION_SOURCE})
  add_dependencies(simbench_recording simbench_version)
  return()
endif()

execute_process(
  COMMAND git --no-optional-locks describe --always --dirty --abbrev=12 --exclude=*
  WORKING_DIRECTORY ${SOURCE_DIR}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "recording/version.h"

namespace simbench {

std::string_view version() { return "@VERSION@"; }
std::string_view commit() { return "@commit@"; }

}  // namespace simbench
]])
