// A folder of its own among the system's temporary files, removed with everything in it.
//
//   TemporaryFolder folder;
//   use(folder.file("rig.json"));
#ifndef SIMBENCH_RECORDING_TEMPORARY_FOLDER_H_
#define SIMBENCH_RECORDING_TEMPORARY_FOLDER_H_

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace simbench {

class TemporaryFolder {
 public:
  // Readable by its owner only. Throws std::runtime_error.
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / "simbench-XXXXXX") {
    if (mkdtemp(path_.data()) == nullptr) {
      throw std::runtime_error(path_ + ": a temporary folder cannot be made here");
    }
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_TEMPORARY_FOLDER_H_
