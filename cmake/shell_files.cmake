# Writes man pages and completion scripts below FOLDER, as PROGRAM (simbench) prints them:
# cmake -D PROGRAM=path -D FOLDER=path -P shell_files.cmake
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1)

# write(FILE ARGUMENT...)
function(write file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${FOLDER}/${file}
                  COMMAND_ERROR_IS_FATAL ANY)
endfunction()

write(simbench completion bash)
write(_simbench completion zsh)
write(simbench.fish completion fish)
write(man1/simbench.1 manual)
execute_process(COMMAND ${PROGRAM} manual --names OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" names "${names}")
foreach(name ${names})
  write(man1/simbench-${name}.1 manual ${name})
endforeach()
