#include "cli/sibling_program.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace simbench::cli {

std::filesystem::path sibling_program(const std::string& name) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
}

int become_sibling(const std::string& name, std::vector<std::string> arguments) {
  const std::string program = sibling_program(name);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  return errno;
}

}  // namespace simbench::cli
