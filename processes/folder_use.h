// What a program's folder holds: how many files and folders, how many bytes, how deep.
//
// A file counts with its length, or with what it takes on the disk where that is more; one with
// several names once. Links are not followed. Counting ends where a limit is passed.
//
//   const int folder = open_folder_in(AT_FDCWD, "world/host0");
//   const FolderUse use = folder_use(folder, {});
//   print(excess_of(use, {}));  // "made more than 4096 files"
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace simbench::processes {

struct FolderUse {
  std::uint64_t bytes = 0;
  std::size_t files = 0;  // and folders, links, pipes, sockets
  std::size_t depth = 0;  // 1: all lie in the folder itself
};

// A daemon's logs of ten hours, statistics of every measurement among them, are some 100 MiB in
// a handful of files.
struct FolderLimits {
  std::uint64_t bytes = std::uint64_t{256} << 20;
  std::size_t files = 4096;
  std::size_t depth = 64;
};

// `folder` is a descriptor, which stays open. What cannot be read counts as nothing.
FolderUse folder_use(int folder, const FolderLimits& limits);

// What one file counts.
std::uint64_t bytes_of_file(const struct stat& status);

// What a program did that has passed a limit; empty: none.
std::string excess_of(const FolderUse& use, const FolderLimits& limits);

}  // namespace simbench::processes
