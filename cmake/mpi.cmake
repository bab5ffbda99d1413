# simbench-mpi, the command whose sweeps are worked on by all ranks of an MPI job: built where an MPI
# and Boost.MPI of the same version as Boost's headers are found (tools/setup check brings both).
# Nothing else needs them.
#
# SIMBENCH_WITH_MPI: AUTO (where they are found), ON (an error where not), OFF.
set(SIMBENCH_WITH_MPI AUTO CACHE STRING "Build simbench-mpi: AUTO, ON or OFF")
set(SIMBENCH_MPI_FOUND FALSE)
if(SIMBENCH_WITH_MPI)
  set(required "")
  if(NOT SIMBENCH_WITH_MPI STREQUAL "AUTO")
    set(required REQUIRED)
  endif()
  find_package(MPI ${required} QUIET COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    # Static: an installed simbench-mpi needs no library that lies in build/deps.
    set(Boost_USE_STATIC_LIBS ON)
    find_package(boost_mpi ${SIMBENCH_BOOST_VERSION} ${required} QUIET CONFIG)
    set(SIMBENCH_MPI_FOUND ${boost_mpi_FOUND})
  endif()
  if(SIMBENCH_MPI_FOUND)
    message(STATUS "simbench-mpi: with MPI ${MPI_CXX_VERSION}, Boost.MPI ${boost_mpi_VERSION}")
  else()
    message(STATUS "simbench-mpi: not built, no MPI or no Boost.MPI ${SIMBENCH_BOOST_VERSION}")
  endif()
endif()
