# simbench_elementary: exp, sin, pow and the like, whose results are the same bits on every machine.
#
# A system's libm chooses its code by the processor (with fused multiply-add or without) and changes
# with its version, and so do last digits. These are newlib's functions in C (fdlibm, and Arm's
# optimised routines), compiled such that each operation rounds by itself. Whatever is linked with
# simbench_flags has them: the linker's --wrap puts them in the place of the system's, in whatever
# order libraries are named, for the program's own code alone. The compiler leaves calls as they are,
# since what it computes itself is rounded in another way.
#
# What is exact anywhere stays the system's: sqrt, floor, fmod, ldexp, frexp, lround.
# tests/house/portable_functions_test.sh says if a program uses another function of libm.
set(SIMBENCH_ELEMENTARY acos acosh asin asinh atan atan2 atanh cbrt cos cosh erf erfc exp exp2 expm1
  hypot log log10 log1p log2 pow sin sincos sinh tan tanh)

enable_language(C)
find_file(SIMBENCH_NEWLIB_ARCHIVE newlib-3.3.0.tar.xz NO_CACHE NO_DEFAULT_PATH
  PATHS ${SIMBENCH_DEPS_DIR}/usr/src/newlib /usr/src/newlib NO_CMAKE_FIND_ROOT_PATH)
if(NOT SIMBENCH_NEWLIB_ARCHIVE)
  message(FATAL_ERROR "newlib 3.3.0's sources: not found; run tools/setup")
endif()
set(newlib ${PROJECT_BINARY_DIR}/generated/newlib)
set(libm ${newlib}/newlib-salsa/newlib/libm)
if(NOT EXISTS ${newlib}/complete)
  file(ARCHIVE_EXTRACT INPUT ${SIMBENCH_NEWLIB_ARCHIVE} DESTINATION ${newlib}
    PATTERNS */newlib/libm/common/*.[ch] */newlib/libm/math/*.c */COPYING.NEWLIB)
  file(TOUCH ${newlib}/complete)
endif()

set(sources "")
foreach(name exp exp2 exp_data log log2 log2_data log_data math_err pow pow_log_data s_cbrt s_expm1
        s_log1p)
  list(APPEND sources ${libm}/common/${name}.c)
endforeach()
foreach(name e_acos e_acosh e_asin e_atan2 e_atanh e_cosh e_hypot e_log10 e_rem_pio2 e_sinh k_cos
        k_rem_pio2 k_sin k_tan s_asinh s_atan s_cos s_erf s_sin s_tan s_tanh w_acos w_acosh w_asin
        w_atan2 w_atanh w_cosh w_hypot w_log10 w_sincos w_sinh)
  list(APPEND sources ${libm}/math/${name}.c)
endforeach()
add_library(simbench_elementary STATIC ${sources})
set_target_properties(simbench_elementary PROPERTIES EXPORT_NAME elementary)

# newlib's headers are another system's. All that the sources need beside the system's own is the
# order of bytes and, since the linker looks for __wrap_exp in place of exp, these names.
set(names "#define __IEEE_LITTLE_ENDIAN\n")
foreach(name ${SIMBENCH_ELEMENTARY})
  string(APPEND names "extern __typeof__(${name}) __wrap_${name};\n#define ${name} __wrap_${name}\n")
endforeach()
file(CONFIGURE OUTPUT ${newlib}/include/machine/ieeefp.h CONTENT "${names}" @ONLY)
target_include_directories(simbench_elementary PRIVATE ${newlib}/include ${libm}/common)
# The sources' other names are also those of glibc, with which a program may be linked statically.
foreach(name __ieee754_acos __ieee754_acosh __ieee754_asin __ieee754_atan2 __ieee754_atanh
        __ieee754_cosh __ieee754_hypot __ieee754_log10 __ieee754_rem_pio2 __ieee754_sinh __exp_data
        __kernel_cos __kernel_rem_pio2 __kernel_sin __kernel_tan __log2_data __log_data
        __math_check_oflow __math_check_uflow __math_divzero __math_invalid __math_oflow
        __math_uflow __pow_log_data)
  target_compile_definitions(simbench_elementary PRIVATE ${name}=simbench_newlib${name})
endforeach()
# No other way of rounding on processors that have one, and no error numbers.
target_compile_definitions(simbench_elementary PRIVATE _GNU_SOURCE _IEEE_LIBM __OBSOLETE_MATH=0
  __ieee754_sqrt=sqrt HAVE_FAST_FMA=0 HAVE_FAST_ROUND=0 WANT_ERRNO=0)
target_compile_options(simbench_elementary PRIVATE -O2 -std=gnu99 -fPIC -fvisibility=hidden
  -ffp-contract=off -w)

foreach(name ${SIMBENCH_ELEMENTARY})
  target_compile_options(simbench_elementary INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fno-builtin-${name}>)
  target_link_options(simbench_elementary INTERFACE LINKER:--wrap=${name})
endforeach()
target_link_libraries(simbench_flags INTERFACE simbench_elementary)
