// A folder of its own among the system's temporary files, removed with everything in it.
//
//   TemporaryFolder folder;
//   use(folder.file("rig.json"));
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "recording/disposable.h"

namespace simbench {

class TemporaryFolder {
 public:
  // Readable by its owner only. Throws std::runtime_error.
  TemporaryFolder() : folder_(make) {}

  const std::string& path() const { return folder_.path().native(); }
  std::string file(const std::string& name) const { return path() + "/" + name; }

 private:
  static std::filesystem::path make() {
    std::string path = std::filesystem::temp_directory_path() / "simbench-XXXXXX";
    if (mkdtemp(path.data()) == nullptr) {
      throw std::runtime_error(path + ": a temporary folder cannot be made here");
    }
    return path;
  }

  Disposable folder_;
};

}  // namespace simbench
