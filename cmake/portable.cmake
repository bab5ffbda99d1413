# What tools/release builds runs on machines that have none of simbench's libraries and an older glibc.
#
# SIMBENCH_PORTABLE: the program is linked statically, with its glibc. The library that is preloaded
# into other programs and the Python module meet the glibc of their process: they are linked with an
# old one, unpacked at SIMBENCH_OLD_GLIBC, whose symbols every later glibc has.
option(SIMBENCH_PORTABLE "Link as tools/release does, for machines of others" OFF)
set(SIMBENCH_OLD_GLIBC "" CACHE PATH "Root of an unpacked older glibc (libc6, libc6-dev)")

if(SIMBENCH_PORTABLE)
  target_compile_definitions(simbench_flags INTERFACE $<BUILD_INTERFACE:SIMBENCH_PORTABLE>)
  # Nothing says where it was built.
  add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
  set(CMAKE_SKIP_RPATH ON)
endif()

# simbench_portable_program(TARGET)
function(simbench_portable_program target)
  if(SIMBENCH_PORTABLE)
    # PIE: at an address that differs each time, as other programs.
    target_link_options(${target} PRIVATE -static-pie)
  endif()
endfunction()

# simbench_old_glibc(TARGET [CXX]): links the libraries of the calling folder with it, in place of the
# compiler's own; TARGET is the one there. CXX: also with C++'s own library, statically, and with what
# that asks of a newer glibc (newer_glibc.cc).
function(simbench_old_glibc target)
  set(libraries ${SIMBENCH_OLD_GLIBC}/lib/${CMAKE_LIBRARY_ARCHITECTURE})
  file(GLOB loader ${libraries}/ld-linux-*.so.*)
  target_link_options(${target} PRIVATE -nodefaultlibs -Wl,--as-needed)
  set(last -lgcc)
  if("CXX" IN_LIST ARGN)
    target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/newer_glibc.cc)
    target_link_options(${target} PRIVATE -Wl,--wrap=stdin -Wl,--wrap=stdout -Wl,--wrap=stderr)
    set(last -Wl,-Bstatic -lstdc++ -lgcc_eh -lgcc -Wl,-Bdynamic)
  endif()
  list(APPEND last ${libraries}/libc.so.6 ${libraries}/libpthread.so.0 ${libraries}/libdl.so.2
    ${libraries}/libm.so.6 ${loader}
    ${SIMBENCH_OLD_GLIBC}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/libc_nonshared.a)
  # After all that asks for them.
  list(JOIN last " " last)
  set(CMAKE_CXX_STANDARD_LIBRARIES ${last} PARENT_SCOPE)
endfunction()
