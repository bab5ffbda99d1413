// The processes that descend from one, and what they use, as /proc tells.
//
// What is gone by the time it is looked at counts as nothing.
//
//   FolderUse use;
//   for (const pid_t each : descendants(getpid())) add_unlinked_files(each, use);
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <vector>

#include "processes/folder_use.h"

namespace simbench::processes {

// Without the ancestor; each before those that it started.
std::vector<pid_t> descendants(pid_t ancestor);

// What it has in memory, shared libraries included.
std::uint64_t resident_bytes(pid_t process);

// Files that it holds open and that have no name any more: no folder shows them.
void add_unlinked_files(pid_t process, FolderUse& use);

}  // namespace simbench::processes
