// Where the files of tests/data are, and what is in one that is JSON; tests/data/README.md
// describes them. A file that is absent or broken fails the test: they are part of the repository.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace simbench {

inline std::string test_data_path(const std::string& name) {
  return SIMBENCH_SOURCE_DIR "/tests/data/" + name;
}

inline nlohmann::json test_data_json(const std::string& name) {
  std::ifstream file(test_data_path(name));
  if (!file) throw std::runtime_error("cannot read " + test_data_path(name));
  return nlohmann::json::parse(file);
}

}  // namespace simbench
