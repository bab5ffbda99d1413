#include "bags/rosbag2_folder.h"

#include <filesystem>
namespace simbench::bags {
bool is_rosbag2_folder(const std::string& folder) {
  return std::filesystem::exists(std::filesystem::path(folder) / "metadata.yaml");
}
std::vector<std::string> rosbag2_files(const std::string& /*folder*/) { return {}; }
}  // namespace simbench::bags
