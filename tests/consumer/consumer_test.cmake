# Installs simbench under WORK_DIR, builds the outside project against it and runs it: its algorithm
# must be a row of the table.
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what}: exit status ${status}\n${out}\n${err}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR}/prefix ${WORK_DIR}/build)
run("install" ${CMAKE_COMMAND} --install ${SIMBENCH_BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run("configure" ${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G Ninja
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
    -D "CMAKE_PREFIX_PATH=${WORK_DIR}/prefix\;${DEPS_DIR}/usr")
run("build" ${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run("list" ${WORK_DIR}/build/my_bench list)
if(NOT output MATCHES "constant_delay")
  message(FATAL_ERROR "the registered algorithm is not listed:\n${output}")
endif()
run("run" ${WORK_DIR}/build/my_bench --scenario ${CONSUMER_DIR}/my_rig.json --seeds 2 --format json)
string(JSON rows LENGTH "${output}" rows)
string(JSON device_time GET "${output}" rows 0 device_time)
if(NOT rows EQUAL 1 OR NOT device_time STREQUAL "constant_delay")
  message(FATAL_ERROR "expected one row with device_time constant_delay, got ${rows}, ${device_time}")
endif()
run("installed command" ${WORK_DIR}/prefix/bin/simbench --version)
