// Which times of a host's files are the machine's.
//
// The kernel stamps each change of a file with the machine's time. The times of the host's clock
// are put there later: by the shim when the program closes what it wrote, by the world at the end
// (sim/programs/host_files.h). The kernel's own note of the last change, st_ctime, is always the
// machine's.
//
// All times are ns since 1970. `born` is when the machine made the host's folder.
//
//   const bool is_own = is_of_host(born, changed);
//   if (is_own && is_of_machine(born, modified, changed)) print("written to since");
#pragma once

#include <cstdint>

namespace simbench::shim {

// Whether the file has changed since, as all files of the host's folder have.
constexpr bool is_of_host(std::int64_t born, std::int64_t changed) { return changed >= born; }

// Whether the kernel has stamped the last writing: with a time that the folder and the last change
// have between them.
constexpr bool is_of_machine(std::int64_t born, std::int64_t modified, std::int64_t changed) {
  return modified >= born && modified <= changed;
}

}  // namespace simbench::shim
