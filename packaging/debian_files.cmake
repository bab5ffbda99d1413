# What a Debian package has besides: cpack runs this where the files lie that it will pack.
set(prefix ${CMAKE_INSTALL_PREFIX})
set(documents ${prefix}/share/doc/simbench)

# compress(FILE): as Debian's policy asks, the same bytes each time.
function(compress file)
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

configure_file(${CPACK_SIMBENCH_PACKAGING}/copyright ${documents}/copyright COPYONLY)
configure_file(${CPACK_SIMBENCH_SOURCE}/CHANGELOG.md ${documents}/changelog COPYONLY)
compress(${documents}/changelog)
configure_file(${CPACK_SIMBENCH_PACKAGING}/lintian-overrides
  ${prefix}/share/lintian/overrides/simbench COPYONLY)
file(REMOVE ${documents}/LICENSE ${documents}/CHANGELOG.md)
file(GLOB manuals ${prefix}/share/man/man1/*.1)
foreach(manual ${manuals})
  compress(${manual})
endforeach()
