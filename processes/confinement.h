// What a program of the simulated world cannot do to the machine on which it runs.
//
// Four barriers of the kernel, which hold whatever the program does, with or without libc:
//
//   user       root's programs are nobody (processes/lesser_user.h)
//   rights     no capabilities, also as root, and none to gain; the calls that ask for rights or
//              give them away succeed without effect (it is the root of a host that is not there)
//   files      Landlock: it reads and executes what is named (processes/readable.h), and writes,
//              makes and removes files in its own folder only, and /dev/null; no device takes a
//              setting; neither signals nor abstract sockets leave it; no TCP (each as far as the
//              kernel's Landlock goes)
//   calls      a filter of system calls (shim/refused_calls.h): clocks, networks, waits, processes
//              and the machine's state are out of reach. A call that the shim should have served
//              stops the program, and the shim names it.
//
// A program of a real host has the machine's network and waits instead of the world's
// (Served::kClock); what network that is, its caller chooses by a namespace. It still sets no
// clock.
//
// Without filters of calls (before Linux 4.14; under an emulator of a processor) nobody runs
// programs: ConfinementError. Without Landlock (before Linux 5.13, or switched off) root runs no
// programs: ConfinementError. For other users the barrier of files is then their ordinary rights,
// and no more.
//
// What remains: that a file or folder is there, its size, its times and where a link leads can be
// seen of all that the user may enter. Unix-domain sockets that others have put into the file
// system can be connected to where the user may write to them. A program that reads the time
// without a system call (the vDSO, the processor's counter) sees the machine's own.
//
//   const char* program = "/usr/sbin/chronyd";
//   char* const none[] = {nullptr};
//   Confinement confinement({.folder = "world/host0", .readable = {"/usr"}});
//   if (fork() == 0) {
//     const Confinement::Failure failure = confinement.apply();
//     if (failure.what == nullptr) execve(program, none, none);
//   }
//
// Source: capabilities(7), landlock(7), seccomp(2), Documentation/userspace-api/landlock.rst.
#pragma once

#include <linux/filter.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "processes/call_filter.h"

namespace simbench::processes {

class ConfinementError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Confinement {
 public:
  struct Failure {
    const char* what = nullptr;  // none
    int error = 0;               // an errno
  };

  struct Settings {
    std::string folder{};                 // its own, which must be there
    std::vector<std::string> readable{};  // files and folders; what is not there is left out
    Served served = Served::kAll;
    bool as_nobody = false;
  };

  // Throws ConfinementError.
  explicit Confinement(const Settings& settings);
  ~Confinement();
  Confinement(const Confinement&) = delete;
  Confinement& operator=(const Confinement&) = delete;

  // In the child, between fork() and execve(): makes async-signal-safe calls only. What the
  // parent's death sends (PR_SET_PDEATHSIG) is forgotten.
  Failure apply();

 private:
  int rules_ = -1;  // Landlock's; none
  bool as_nobody_;
  std::vector<sock_filter> filter_;
};

}  // namespace simbench::processes
