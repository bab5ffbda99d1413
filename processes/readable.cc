#include "processes/readable.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <system_error>

namespace simbench::processes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLibraries[] = {"/lib", "/lib32", "/lib64", "/usr", "/bin", "/sbin"};
constexpr const char* kDevices[] = {"/dev/null", "/dev/zero", "/dev/full"};
constexpr const char* kOfMachine[] = {"/etc/resolv.conf", "/etc/hosts", "/dev/random",
                                      "/dev/urandom", "/sys/class/net"};

// The users' folders, as the machine's list of users has them.
std::set<fs::path> homes() {
  std::set<fs::path> result;
  std::ifstream users("/etc/passwd");
  for (std::string line; std::getline(users, line);) {
    std::istringstream fields(line);
    std::string home;
    for (int i = 0; i < 6; ++i) std::getline(fields, home, ':');
    if (!home.empty()) result.insert(fs::path(home).lexically_normal());
  }
  return result;
}

bool is_common(const fs::path& folder) {
  if (folder.parent_path() == folder.root_path()) return true;
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0 || (status.st_mode & S_IWOTH) != 0) return true;
  return homes().contains(folder);
}

bool is_file(const fs::path& path) {
  std::error_code missing;
  return fs::is_regular_file(path, missing);
}

void add_with_folder(const fs::path& path, std::vector<std::string>& paths) {
  if (is_file(path)) {
    paths.push_back(path.string());
    if (!is_common(path.parent_path())) paths.push_back(path.parent_path().string());
  } else if (!is_common(path)) {
    paths.push_back(path.string());
  }
}

void add_libraries_of(const fs::path& program, std::vector<std::string>& paths) {
  const fs::path folder = program.parent_path();
  if (folder.filename() != "bin" && folder.filename() != "sbin") return;
  for (const char* each : {"lib", "lib64", "libexec", "share", "pyvenv.cfg"}) {
    paths.push_back((folder.parent_path() / each).string());
  }
}

void add_listed(const std::map<std::string, std::string>& environment,
                std::vector<std::string>& paths) {
  for (const char* variable : {"LD_LIBRARY_PATH", "PATH", "PYTHONPATH"}) {
    const auto found = environment.find(variable);
    if (found == environment.end()) continue;
    std::istringstream folders(found->second);
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (folder.starts_with('/')) paths.push_back(folder);
    }
  }
}

// The path, and what it is a link to.
std::vector<fs::path> names_of(const std::string& path) {
  std::vector<fs::path> names{fs::path(path).lexically_normal()};
  std::error_code missing;
  const fs::path whole = fs::canonical(path, missing);
  if (!missing && whole != names.front()) names.push_back(whole);
  return names;
}

// Debian's Python reads its settings there.
void add_python_settings(std::vector<std::string>& paths) {
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator("/etc", missing)) {
    if (entry.path().filename().string().starts_with("python")) {
      paths.push_back(entry.path().string());
    }
  }
}

}  // namespace

std::vector<std::string> readable_paths(const ReadableOf& of) {
  std::vector<std::string> paths = of.readable;
  paths.push_back(of.shim);
  for (const fs::path& name : names_of(of.program)) {
    add_with_folder(name, paths);
    add_libraries_of(name, paths);
  }
  for (const std::string& word : of.words) {
    if (!word.starts_with('/')) continue;
    for (const fs::path& name : names_of(word)) add_with_folder(name, paths);
  }
  add_listed(of.environment, paths);
  paths.insert(paths.end(), std::begin(kLibraries), std::end(kLibraries));
  paths.insert(paths.end(), std::begin(kSystemFiles), std::end(kSystemFiles));
  paths.insert(paths.end(), std::begin(kDevices), std::end(kDevices));
  add_python_settings(paths);
  if (of.served == Served::kClock) {
    paths.insert(paths.end(), std::begin(kOfMachine), std::end(kOfMachine));
  }
  return paths;
}

std::vector<std::string> needed_paths(const ReadableOf& of) {
  std::vector<std::string> paths{of.program, of.shim};
  for (const std::string& word : of.words) {
    if (word.starts_with('/')) paths.push_back(word);
  }
  paths.insert(paths.end(), of.readable.begin(), of.readable.end());
  add_listed(of.environment, paths);
  return paths;
}

}  // namespace simbench::processes
