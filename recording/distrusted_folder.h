// Folders in which somebody who is not trusted makes what he likes: links, pipes, folders that
// nobody may read, folders in folders without end.
//
// No link is followed, nothing blocks, and neither the length of a path nor the number of
// descriptors sets a limit.
//
//   const int folder = open_folder_in(AT_FDCWD, "world");
//   close(folder);
//   remove_tree("world");
#pragma once

#include <filesystem>

namespace simbench {

// A descriptor for reading the folder `name` of another folder, to which its owner has every right
// from then on; -1 with errno, ENOTDIR for a link.
int open_folder_in(int parent, const char* name);

// Removes the file, link or folder with everything in it. Returns whether nothing is left.
bool remove_tree(const std::filesystem::path& path);

}  // namespace simbench
