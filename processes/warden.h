// A small process between this one and a program, which sees to it that nothing of the program is
// left: neither it nor what it started, in whatever group, session or generation.
//
// Orphans of the program become the warden's children. It kills all of them when it is told to, and
// when the thread that made it ends, whatever ends that: SIGKILL too. A warden outlives its program
// as long as there are such children.
//
//   Warden warden([](pid_t) { execl("/bin/true", "true", nullptr); _exit(127); });
//   if (const std::optional<int> status = warden.status(std::chrono::seconds(1))) {
//     print(WEXITSTATUS(*status));
//   }
//   warden.end();
//
// Errors: none are thrown; error() is the errno of the fork that failed.
//
// Source: PR_SET_CHILD_SUBREAPER, PR_SET_PDEATHSIG in prctl(2).
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>

namespace simbench::processes {

class Warden {
 public:
  // None.
  Warden() = default;
  // `become` runs in the program's process, which gets its parent's number, and must not return.
  // `orphaned` runs in the warden's when it has killed all because its own parent has ended. Both
  // may make async-signal-safe calls only.
  explicit Warden(const std::function<void(pid_t parent)>& become,
                  const std::function<void()>& orphaned = {});
  ~Warden();
  Warden(const Warden&) = delete;
  Warden& operator=(const Warden&) = delete;
  Warden(Warden&& other) noexcept;
  Warden& operator=(Warden&& other) noexcept;

  int error() const { return error_; }
  // The program's process; -1: none.
  pid_t program() const { return program_; }
  // The parent of its orphans; -1: none.
  pid_t process() const { return process_; }
  // How the program ended, as waitpid() has it; nothing if it has not within this time.
  std::optional<int> status(std::chrono::milliseconds patience);
  // Kills all, and waits until they are gone.
  void end();

 private:
  pid_t process_ = -1;
  pid_t program_ = -1;
  int messages_ = -1;  // a pipe: first the program's number or an error, then its status
  int error_ = 0;
  std::optional<int> status_;
};

}  // namespace simbench::processes
