# What a Debian package has besides: cpack runs this where the files lie that it will pack.
set(prefix ${CPACK_TEMPORARY_DIRECTORY}/program/usr)
set(documents ${prefix}/share/doc/simbench)

# run(WORD...)
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

configure_file(${CPACK_SIMBENCH_SOURCE}/packaging/copyright ${documents}/copyright COPYONLY)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH's
file(WRITE ${documents}/changelog
"simbench (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * What changed is in /usr/share/doc/simbench/CHANGELOG.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(REMOVE ${documents}/LICENSE)  # of which copyright says where it is
configure_file(${CPACK_SIMBENCH_SOURCE}/packaging/lintian-overrides
  ${prefix}/share/lintian/overrides/simbench COPYONLY)

# As Debian's policy asks, and the same bytes each time.
file(GLOB manuals ${prefix}/share/man/man1/*.1)
run(gzip -9nf ${documents}/changelog ${manuals})
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  run(find ${CPACK_TEMPORARY_DIRECTORY} -exec touch --no-dereference --date=@$ENV{SOURCE_DATE_EPOCH} {} +)
endif()
