// One process of the simulated world, or of a real host whose clock alone is served: a real program
// that lives while the world asks it to.
//
// It is started with the shim preloaded (shim/link.h) in a folder of its own, with an empty
// environment but for what is stated, no input, and its output in a file of that folder
// (processes/program_log.h). While it computes, the world stands still: next() blocks until it asks
// for something. The destructor kills it and all that it started, and so does whatever ends this
// process (processes/warden.h).
//
// It is confined (processes/confinement.h): it writes in its folder only and reads what is named,
// and a call that passes libc by and would reach the real clocks, a network or another process ends
// it, by name. It inherits no descriptors and no signals, and sees itself as root of its host.
// Root's programs are nobody's where that can be.
//
// It runs on the CPU of the thread that serves it: one of the two waits always, and to wake another
// CPU costs more than most requests. A process of a real host (Served::kClock) runs where it likes,
// and the world waits for it by link(), next() being due when that can be read.
//
// Limits, each of which ends it, and ending() says which. Addresses are not randomised, so that its
// bytes repeat; no core is dumped.
//
//   time     `patience` of real time for a request; in all kPatiencesInAll times that, beside
//            kShare a request; of the processor, kMostCpu patiences
//   memory   kMostMemory bytes of its own data, and RunUse of the run's programs together
//            (processes/program_use.h)
//   disk     kMostOutput bytes a file, FolderLimits of its folder together with the files that it
//            holds open and that have no name (processes/folder_use.h)
//   others   kMostDescriptors; no process beyond RunUse::kMostProcesses of its user
//
// The disk and the memory are looked at with every kLookEvery-th request, so that the verdict is
// the program's doing and not the machine's speed, and while it computes for long, so that the
// machine is safe.
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
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "processes/call_filter.h"
#include "processes/folder_use.h"
#include "processes/program_log.h"
#include "processes/program_use.h"
#include "processes/thread_link.h"
#include "processes/warden.h"

namespace simbench::processes {

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
  // A daemon's answer takes 20 to 200 us, a slow machine's Python some ms.
  static constexpr int kPatiencesInAll = 10;
  static constexpr std::chrono::milliseconds kShare{10};
  // An hour: a week of a Python program's simulated time is a quarter of one.
  static constexpr int kMostCpu = 120;
  static constexpr std::size_t kMostOutput = std::size_t{64} << 20;
  static constexpr std::size_t kMostMemory = std::size_t{1} << 30;
  // What is only set aside costs nothing; node does so with 10 GiB for a memory of WebAssembly.
  static constexpr std::size_t kMostAddresses = std::size_t{64} << 30;
  static constexpr std::size_t kMostStack = std::size_t{8} << 20;
  static constexpr std::size_t kMostDescriptors = 1024;
  static constexpr std::uint64_t kLookEvery = 4096;

  struct Settings {
    std::vector<std::string> command{};  // as the program sees it
    std::string program{};               // its absolute path; empty: the command's first word
    std::map<std::string, std::string> environment{};
    std::string folder{};                 // absolute; its working folder
    std::string log_name{};               // within the folder
    std::string shim{};                   // absolute
    std::vector<std::string> readable{};  // files and folders, absolute, beside the usual
    std::chrono::milliseconds patience = kPatience;
    FolderLimits folder_limits{};
    std::shared_ptr<RunUse> run{};  // what its run's programs use; empty: it is alone
    Served served = Served::kAll;
    std::optional<bool> as_nobody{};  // nothing: where that can be (processes/lesser_user.h)
    int clock_page = -1;              // kClock: the descriptor of its memory (shim/clock_page.h)
    // The other end of a link that is there: nothing is started. Whose processes it belongs to
    // (use()), if limits are to be looked at while it computes.
    int link = -1;
    std::shared_ptr<ProgramUse> use{};
  };

  explicit Child(const Settings& settings);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Nothing: it has ended, has passed a limit, or is asleep, as ThreadLink::next() has it.
  std::optional<ChildRequest> next(const std::function<bool()>& is_asleep = {});
  // Its link; without a descriptor if it could not be started.
  ThreadLink& thread_link() { return *link_; }
  int link() const { return link_->descriptor(); }
  std::chrono::milliseconds patience() const { return patience_; }
  // What the machine calls it; -1: nothing was started.
  pid_t process() const { return warden_.program(); }
  // The limit that it has passed; empty: none.
  const std::string& excess() const { return excess_; }
  // What it and all that it started use, for links of the latter; empty once it has ended.
  const std::shared_ptr<ProgramUse>& use() const { return use_; }
  void reply(std::int64_t value, int error, std::span<const std::byte> data);
  // Kills it if it still runs; says how it ended, or in place of that the reason for killing it. To
  // be called once.
  ProgramEnd end_of(const std::string& reason = "");
  // The same as a text.
  std::string ending(const std::string& reason = "") { return end_of(reason).text(); }

 private:
  // Returns why it cannot be started, or nothing.
  std::string start(const Settings& settings, int& link);
  void follow_thread();
  bool is_within_limits(std::chrono::steady_clock::duration waited);
  // Returns how it ended, and sets its exit status.
  std::string end();
  std::string how_it_ended(std::optional<int> status) const;

  std::string name_;
  std::string obstacle_;  // to its start
  std::chrono::milliseconds patience_;
  std::unique_ptr<ThreadLink> link_;
  ProgramLog log_;
  std::shared_ptr<ProgramUse> use_;
  Warden warden_;
  bool is_started_ = false;
  std::uint64_t asked_ = 0;
  std::chrono::steady_clock::duration computed_{};  // in real time, in all
  std::string excess_;                              // the limit that it has passed
  Served served_;
  int cpu_ = -1;  // the one that it is bound to
  std::optional<int> exit_status_;
};

// Whether a program of these settings would be root's and stay it, and why: one line, or empty.
std::string why_root(const Child::Settings& settings);
// For root's programs that share a folder: all are nobody's, who is given the folder, or none is.
void agree_on_user(std::vector<Child::Settings>& programs);

}  // namespace simbench::processes
