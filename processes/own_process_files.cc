#include "processes/own_process_files.h"

#include <fcntl.h>

#include <array>
#include <charconv>
#include <cstring>

namespace simbench::processes {

void hold_own_process_files(pid_t process) {
  std::array<char, 64> name{};
  char* const number = stpcpy(name.data(), "/proc/");
  char* const file = std::to_chars(number, name.data() + name.size(), process).ptr;
  for (const char* each : kOwnProcessFiles) {
    strcpy(stpcpy(file, "/"), each);
    open(name.data(), O_PATH | O_CLOEXEC);
  }
}

}  // namespace simbench::processes
