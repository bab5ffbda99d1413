// A control group of the kernel (cgroup v2) for the programs of one run: their memory and their
// number have a limit together, which the kernel sees to at once.
//
// It is made beside the group of this process, or below it, where this process may: as root, or in
// a part of the tree that is its user's. Where the kernel's controllers are not there (the older
// cgroups, a container) it has no limits; where no group can be made there is none. Both are no
// errors: other limits remain (processes/program_use.h).
//
// The destructor kills who is in it and removes it. Groups of processes that have ended without
// that are removed when the next one is made: the name has the process's number.
//
//   ControlGroup group({.memory = std::uint64_t{4} << 30, .processes = 4096});
//   write(group.entrance(), "0", 1);  // by a process that is to be in it
//   if (group.has_run_out()) print("out of memory");
//
// Source: Documentation/admin-guide/cgroup-v2.rst.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace simbench::processes {

class ControlGroup {
 public:
  struct Limits {
    std::uint64_t memory = 0;  // bytes
    std::size_t processes = 0;
  };

  explicit ControlGroup(const Limits& limits);
  ~ControlGroup();
  ControlGroup(const ControlGroup&) = delete;
  ControlGroup& operator=(const ControlGroup&) = delete;

  // A descriptor; -1: there is no group.
  int entrance() const { return entrance_; }
  // Empty: there is none.
  const std::filesystem::path& path() const { return path_; }
  // Whether the kernel has killed one of them for the memory.
  bool has_run_out() const;

 private:
  std::filesystem::path path_;
  int entrance_ = -1;
};

// Where the group of this process is in the file system; empty: nowhere.
std::filesystem::path own_control_group();

}  // namespace simbench::processes
