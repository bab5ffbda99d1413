// A program that attacks, in a folder of its own and in a world that grants every request; and what
// is to be the same afterwards: a folder into which everybody may write, the machine's name, its
// clock, this process, and which processes there are.
//
//   AttackedMachine machine;
//   const Attacked result = machine.run({.program = "file_attacks", .words = {"up"}});
//   print(result.output);
//   EXPECT_EQ(machine.change(), "");
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "processes/child.h"
#include "tests/scratch_folder.h"

namespace simbench::processes {

struct Attack {
  std::string program;  // of tests/programs
  std::vector<std::string> words{};
  std::chrono::milliseconds patience = std::chrono::seconds(5);
  FolderLimits disk{};
  std::uint64_t memory = RunUse::kMostMemory;
  std::vector<std::string> readable{};
  // The other's folder is named so that the shim does not take it for one of the host's own
  // (shim/paths.h), and only the kernel can refuse.
  bool passes_shim_by = false;
};

struct Attacked {
  std::string output;
  std::string ending;
  double took_s = 0;
};

class AttackedMachine {
 public:
  AttackedMachine();
  ~AttackedMachine();
  AttackedMachine(const AttackedMachine&) = delete;
  AttackedMachine& operator=(const AttackedMachine&) = delete;

  // The folder into which everybody may write: "file", "sub" and "socket", root's alone.
  std::string canary() const { return canary_.path().string(); }
  const ScratchFolder& folder() const { return folder_; }
  Child::Settings settings(const Attack& attack) const;
  // `canary` is added to the words.
  Attacked run(const Attack& attack) const;
  // What is another than it was, or is left; empty: nothing. Waits a moment for what is ending.
  std::string change() const;

 private:
  std::string state() const;

  ScratchFolder folder_;
  ScratchFolder canary_;
  int socket_ = -1;
  int abstract_ = -1;
  std::string before_;
  double clock_s_ = 0;
};

// What CLOCK_REALTIME is before CLOCK_MONOTONIC.
double machines_clock_s();

// How a program ends that does nothing but ask.
std::string ending_of(const Child::Settings& settings);

}  // namespace simbench::processes
