// A folder of a test's own, with the files that it writes there, removed with it.
#ifndef SIMBENCH_TESTS_HARDWARE_CAMERA_FILLED_FOLDER_H_
#define SIMBENCH_TESTS_HARDWARE_CAMERA_FILLED_FOLDER_H_

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace simbench::hardware {

class FilledFolder {
 public:
  FilledFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "simbench_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~FilledFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FilledFolder(const FilledFolder&) = delete;
  FilledFolder& operator=(const FilledFolder&) = delete;

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

  // Whole or not at all, as a reader beside it sees it.
  std::string write(const std::string& name, const std::string& content) const {
    std::string path = *this / name;
    std::ofstream(path + ".part") << content;
    std::filesystem::rename(path + ".part", path);
    return path;
  }

 private:
  std::string path_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_TESTS_HARDWARE_CAMERA_FILLED_FOLDER_H_
