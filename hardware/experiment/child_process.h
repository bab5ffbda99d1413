// A program started as a child, which cannot outlive its parent.
//
// It dies with the thread that started it (PR_SET_PDEATHSIG: SIGKILL). The destructor ends it with
// SIGTERM, then SIGKILL, and collects its status. Its standard output is read line by line;
// standard error goes to a file.
//
// Errors: ChildError, with the last lines of its standard error.
//
//   ChildProcess node({.program = "/proc/self/exe", .arguments = {"node"}, .log = "node0.log"});
//   std::string line = node.read_line(deadline);  // "node host0: listening on ..."
#pragma once

#include <sys/types.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "hardware/clock/monotonic_time.h"
#include "hardware/descriptor.h"

namespace simbench::hardware {

class ChildError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ChildProcess {
 public:
  struct Settings {
    std::string program;
    std::vector<std::string> leading{};  // words before the arguments, as an interpreter needs them
    std::vector<std::string> arguments;  // without the program's own name
    std::string log;                     // a file; for standard error
    // The member of a NetworkSandbox in whose namespace it runs; none: in the caller's.
    std::optional<unsigned> sandbox_member;
    bool has_wire = false;  // and the programs' network there
  };

  explicit ChildProcess(const Settings& settings);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t id() const { return process_; }
  // The next line of its standard output. Throws ChildError at the deadline, or if there is none.
  std::string read_line(MonotonicTime deadline);
  // Sends SIGTERM, SIGKILL after `patience`; returns the rest of its standard output.
  std::string end(Nanoseconds patience);

 private:
  [[noreturn]] void fail(const std::string& problem) const;
  // False at the end of the output and at the deadline.
  bool read_more(MonotonicTime deadline);
  bool collect(Nanoseconds patience);

  std::string name_;
  std::string log_;
  pid_t process_ = -1;
  Descriptor output_;
  std::string read_;
};

}  // namespace simbench::hardware
