// The files of a folder that rosbag2 recorded: a bag may be split into several.
//
//   for (const std::string& file : rosbag2_files("rosbag2_2024_05_01")) read_bag(file, sink);
//
// Errors: BagError for a folder without bags, and for files that rosbag2 compressed whole.
// Source: rosbag2's metadata.yaml, relative_file_paths.
#pragma once

#include <string>
#include <vector>

namespace simbench::bags {

// Whether the folder has what rosbag2 writes, and is no recording folder of simbench.
bool is_rosbag2_folder(const std::string& folder);

// In the order of metadata.yaml; without one, of the numbers in their names. Files that
// metadata.yaml names and that are missing are returned, too: reading them says so.
// A file that it names twice is returned once, with a note.
std::vector<std::string> rosbag2_files(const std::string& folder,
                                       std::vector<std::string>* notes = nullptr);

}  // namespace simbench::bags
