#ifndef SIMBENCH_BAGS_ROSBAG2_FOLDER_H_
#define SIMBENCH_BAGS_ROSBAG2_FOLDER_H_
#include <string>
#include <vector>
namespace simbench::bags {
bool is_rosbag2_folder(const std::string& folder);
std::vector<std::string> rosbag2_files(const std::string& folder);
}  // namespace simbench::bags
#endif  // SIMBENCH_BAGS_ROSBAG2_FOLDER_H_
