// One process of the simulated world, or of a real host whose clock alone is served: a real program
// that lives while the world asks it to.
//
// It is started with the shim preloaded (shim/link.h) in a folder of its own, with an empty
// environment but for what is stated, no input, and its output in a file of that folder. While it
// computes, the world stands still: next() blocks until it asks for something, at most kPatience of
// real time. The destructor kills it.
//
// It is confined (processes/confinement.h): it writes in its folder only, and a call that passes
// libc by and would reach the real clocks, a network or another process ends it, by name. It
// inherits no descriptors and no signals, is one process, and sees itself as root of its host.
//
// It runs on the CPU of the thread that serves it: one of the two waits always, and to wake another
// CPU costs more than most requests. A process of a real host (Served::kClock) runs where it likes,
// and the world waits for it by link(), next() being due when that can be read.
//
// Limits: kMostOutput bytes a file, kMostMemory of address space, kMostDescriptors, no core dump.
// Addresses are not randomised, so that its bytes repeat.
//
// The library reaches only what loads libraries: look at the program first
// (sim/programs/program_file.h). It dies with the thread that makes this, not with the last one of
// the process, so that thread must outlive it; and with that thread, whatever ends it.
//
// Errors: none are thrown. One that cannot be started has ended; ending() says why.
//
//   Child child({.command = {"/usr/sbin/chronyd", "-d"}, .log_name = "chronyd.log"});
//   while (const std::optional<ChildRequest> request = child.next()) child.reply(0, 0, {});
//   const ProgramEnd end = child.end_of();
//   print(end.text());  // "chronyd: exited with status 1: Could not open configuration file"
//   if (end.status == 0) print("it has done what it was asked to");
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"
#include "processes/call_filter.h"
#include "shim/protocol.h"

namespace simbench::processes {

struct ChildRequest {
  shim::Request head;
  Bytes data;
  bool is_whole = false;  // there is a head, and as much data as it says
};

// How a program ended. The texts are printable lines, whatever the program wrote.
struct ProgramEnd {
  std::string program{};        // its name, "chronyd"
  std::string how{};            // "exited with status 1"
  std::string last_words{};     // the last line of its output, cut; empty: it said nothing
  std::optional<int> status{};  // its exit status; nothing: it did not exit by itself

  // "chronyd: exited with status 1: Could not open configuration file".
  std::string text() const;
};

class Child {
 public:
  static constexpr std::chrono::seconds kPatience{30};
  static constexpr std::size_t kMostOutput = std::size_t{64} << 20;
  static constexpr std::size_t kMostMemory = std::size_t{1} << 30;
  static constexpr std::size_t kMostDescriptors = 1024;

  struct Settings {
    std::vector<std::string> command{};  // as the program sees it
    std::string program{};               // its absolute path; empty: the command's first word
    std::map<std::string, std::string> environment{};
    std::string folder{};    // absolute; its working folder
    std::string log_name{};  // within the folder
    std::string shim{};      // absolute
    std::chrono::milliseconds patience = kPatience;
    Served served = Served::kAll;
    int clock_page = -1;  // kClock: the descriptor of its memory (shim/clock_page.h)
    int link = -1;        // the other end of somebody else's link: nothing is started
  };

  explicit Child(const Settings& settings);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Nothing: it has ended, or has computed for longer than kPatience.
  std::optional<ChildRequest> next();
  // The descriptor of its link; -1 if it could not be started.
  int link() const { return link_; }
  void reply(std::int64_t value, int error, std::span<const std::byte> data);
  // Kills it if it still runs; says how it ended, or in place of that the reason for killing it. To
  // be called once.
  ProgramEnd end_of(const std::string& reason = "");
  // The same as a text.
  std::string ending(const std::string& reason = "") { return end_of(reason).text(); }

 private:
  // Returns why it cannot be started, or nothing.
  std::string start(const Settings& settings);
  void follow_thread();
  // Returns how it ended, and sets its exit status.
  std::string end();
  std::string how_it_ended(bool itself, int status) const;
  std::string last_line() const;

  std::string name_;
  std::string log_;
  std::string obstacle_;  // to its start
  std::chrono::milliseconds patience_;
  int link_;
  pid_t process_ = -1;
  bool has_asked_ = false;
  Served served_;
  int cpu_ = -1;  // the one that it is bound to
  bool was_too_slow_ = false;
  std::optional<int> exit_status_;
  Bytes buffer_;
};

}  // namespace simbench::processes
