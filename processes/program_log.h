// The file to which a program's output goes.
//
// It is read by the descriptor that was opened before the program began: whatever the program then
// puts into its folder under this name, a link, a pipe, a folder, is not looked at.
//
//   const int host_folder = open_folder_in(AT_FDCWD, "world/host0");
//   ProgramLog log(host_folder, "0_chronyd.log");
//   dup2(log.descriptor(), STDOUT_FILENO);
//   print(log.last_line());
//
// Errors: none are thrown; error() is the errno of the attempt to make it.
#pragma once

#include <string>

namespace simbench::processes {

class ProgramLog {
 public:
  // None.
  ProgramLog() = default;
  // Made anew in the folder of this descriptor.
  ProgramLog(int folder, const std::string& name);
  ~ProgramLog();
  ProgramLog(const ProgramLog&) = delete;
  ProgramLog& operator=(const ProgramLog&) = delete;
  ProgramLog(ProgramLog&& other) noexcept;
  ProgramLog& operator=(ProgramLog&& other) noexcept;

  // -1: none.
  int descriptor() const { return descriptor_; }
  int error() const { return error_; }
  // The end of it, 400 bytes at most, for it need not have lines; empty: nothing was written.
  std::string last_line() const;

 private:
  int descriptor_ = -1;
  int error_ = 0;
};

}  // namespace simbench::processes
