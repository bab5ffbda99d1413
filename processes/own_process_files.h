// What a confined program may read of itself below /proc: the rest of it tells of the machine.
//
// Landlock knows files by their inodes, and those of /proc live no longer than somebody holds them
// open; hold_own_process_files() does for the process that calls it.
//
//   hold_own_process_files(4711);
#pragma once

#include <sys/types.h>

namespace simbench::processes {

// fd: its descriptors, as closefrom() and Python's subprocess list them. maps: where its stack is,
// for threads of Rust and of C++.
inline constexpr const char* kOwnProcessFiles[] = {"cmdline", "comm", "fd", "limits", "maps"};

// Makes async-signal-safe calls only.
void hold_own_process_files(pid_t process);

}  // namespace simbench::processes
