#include "processes/process_tree.h"

#include <dirent.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <string>

namespace simbench::processes {
namespace {

// The names in the folder that are numbers.
std::vector<int> numbers_in(const std::string& folder) {
  std::vector<int> numbers;
  DIR* entries = opendir(folder.c_str());
  if (entries == nullptr) return numbers;
  while (const dirent* entry = readdir(entries)) {
    char* end = nullptr;
    const long number = std::strtol(entry->d_name, &end, 10);
    if (end != entry->d_name && *end == '\0') numbers.push_back(static_cast<int>(number));
  }
  closedir(entries);
  return numbers;
}

// Each thread has children of its own.
void add_children(pid_t parent, std::vector<pid_t>& found) {
  for (const int thread : numbers_in(fmt::format("/proc/{}/task", parent))) {
    std::ifstream children(fmt::format("/proc/{}/task/{}/children", parent, thread));
    for (pid_t child = 0; children >> child;) found.push_back(child);
  }
}

}  // namespace

std::vector<pid_t> descendants(pid_t ancestor) {
  std::vector<pid_t> found;
  add_children(ancestor, found);
  for (std::size_t i = 0; i < found.size(); ++i) add_children(found[i], found);
  return found;
}

std::uint64_t resident_bytes(pid_t process) {
  std::ifstream pages(fmt::format("/proc/{}/statm", process));
  std::uint64_t size = 0;
  std::uint64_t resident = 0;
  if (!(pages >> size >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void add_unlinked_files(pid_t process, FolderUse& use) {
  for (const int descriptor : numbers_in(fmt::format("/proc/{}/fd", process))) {
    struct stat status {};
    const std::string name = fmt::format("/proc/{}/fd/{}", process, descriptor);
    if (stat(name.c_str(), &status) != 0) continue;
    if (!S_ISREG(status.st_mode) || status.st_nlink > 0) continue;
    ++use.files;
    use.bytes += bytes_of_file(status);
  }
}

}  // namespace simbench::processes
