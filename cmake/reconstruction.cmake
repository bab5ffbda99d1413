# What `simbench reconstruct` needs: Embree (casts rays) and Open3D (fuses points, Poisson, PLY, PNG).
# Built where both are found (tools/run --with-reconstruction and tools/setup full bring them), left
# out elsewhere: then the command says how to get it. Nothing else needs them.
#
# SIMBENCH_WITH_RECONSTRUCTION: AUTO (where they are found), ON (an error where not), OFF.
set(SIMBENCH_WITH_RECONSTRUCTION AUTO CACHE STRING "Build the reconstruction: AUTO, ON or OFF")
set(SIMBENCH_RECONSTRUCTION_FOUND FALSE)
if(SIMBENCH_WITH_RECONSTRUCTION)
  set(required "")
  if(NOT SIMBENCH_WITH_RECONSTRUCTION STREQUAL "AUTO")
    set(required REQUIRED)
  endif()
  find_package(embree 3.13 ${required} QUIET CONFIG)
  # Open3D's package answers to its exact version only.
  find_package(Open3D ${required} QUIET CONFIG)
  if(embree_FOUND AND Open3D_FOUND)
    set(SIMBENCH_RECONSTRUCTION_FOUND TRUE)
  endif()
endif()
if(SIMBENCH_RECONSTRUCTION_FOUND)
  message(STATUS "simbench reconstruct: with Embree ${embree_VERSION}, Open3D ${Open3D_VERSION}")
else()
  message(STATUS "simbench reconstruct: not built, no Embree or no Open3D")
endif()
