// Keeps the memory that one run frees for the next, instead of giving it back to the system.
//
// Runs are alike: each needs what the one before has freed, a few megabytes. Returned to the
// kernel and asked for again, that memory costs page faults, about a sixth of a run's time. A
// setting of the whole process, so the program's choice and not the library's.
#ifndef SIMBENCH_CLI_FREED_MEMORY_H_
#define SIMBENCH_CLI_FREED_MEMORY_H_

namespace simbench::cli {

// Call once, before there are threads. Without glibc it does nothing.
void keep_freed_memory();

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_FREED_MEMORY_H_
