# The Debian package, of the component `program`: cpack -G DEB in a build folder. tools/release calls
# it for builds with SIMBENCH_PORTABLE, which depend on no library.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_PACKAGE_NAME simbench)
set(CPACK_PACKAGE_CONTACT "The simbench developers <simbench@localhost>")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME simbench)
set(CPACK_DEBIAN_PROGRAM_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"simbench simulates trigger pulses, the clocks of cameras and hosts, delivery by
USB and the network, runs real synchronisation, regression and gathering code
in that world, and scores it against a truth that no rig has. The same command
runs real hosts and cameras, reads recordings of rigs, and compares algorithms
in continuous integration.")
# The glibc of the programs into which the shim is preloaded.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libc6 (>= 2.17)")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "chrony, linuxptp, ntpsec, python3")
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
else()
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE amd64)
endif()
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/packaging/debian_files.cmake)
set(CPACK_SIMBENCH_SOURCE ${PROJECT_SOURCE_DIR})
include(CPack)
