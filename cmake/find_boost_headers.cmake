# simbench_find_boost_headers(MINIMUM [EXACT] [HINTS folder...])
#
# Sets SIMBENCH_BOOST_INCLUDE_DIR to a folder with Boost's headers of at least MINIMUM (with EXACT:
# of just that major.minor), and SIMBENCH_BOOST_VERSION; the hints come before the system's. To a
# false value where there is none. find_package(Boost) is not used: it takes the first Boost it
# sees, and Debian 12's default is too old. A value given with -DSIMBENCH_BOOST_INCLUDE_DIR counts.
function(simbench_find_boost_headers minimum)
  cmake_parse_arguments(arg "EXACT" "" "HINTS" ${ARGN})
  set(found FALSE)
  foreach(folder ${SIMBENCH_BOOST_INCLUDE_DIR} ${arg_HINTS} /usr/local/include /usr/include)
    if(NOT EXISTS ${folder}/boost/asio/awaitable.hpp)
      continue()
    endif()
    file(STRINGS ${folder}/boost/version.hpp line REGEX "^#define BOOST_LIB_VERSION ")
    string(REGEX REPLACE ".*\"([0-9]+)_([0-9]+).*" "\\1.\\2" version "${line}")
    if(version VERSION_EQUAL minimum OR (version VERSION_GREATER minimum AND NOT arg_EXACT))
      set(found ${folder})
      break()
    endif()
  endforeach()
  set(SIMBENCH_BOOST_INCLUDE_DIR ${found} PARENT_SCOPE)
  set(SIMBENCH_BOOST_VERSION ${version} PARENT_SCOPE)
endfunction()
