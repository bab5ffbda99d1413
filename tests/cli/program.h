// Runs the real simbench program as a user would, and keeps what it printed.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/scratch_folder.h"

namespace simbench {

struct ProgramResult {
  int status = -1;  // exit status; 128 + signal if a signal ended it
  std::string out;
  std::string err;
};

struct ProgramOptions {
  // SIGINT so long after the program has begun to handle it, that is, in the midst of its work: how
  // long it takes to get there depends on the machine. The second one is up to the test.
  std::optional<std::chrono::milliseconds> interrupt_after = std::nullopt;
  // Besides, not before this file of the test's folder has something in it.
  std::string interrupt_once_written = {};
  // SIGINT so long after the start, wherever the program is then, so many times.
  std::optional<std::chrono::microseconds> interrupt_at = std::nullopt;
  int interrupts = 1;
  // Writes beyond this size fail, as on a full disk.
  std::optional<std::size_t> largest_file = std::nullopt;
  // "NAME=value" each, beside what the test's own environment has (COLUMNS is taken from that).
  std::vector<std::string> environment = {};
  // Where standard output goes instead of ProgramResult::out.
  std::string out_file = {};
  // What the kernel lacks: words of tests/programs/older_kernel.cc.
  std::vector<std::string> kernel_without = {};
  // Nothing is open as standard output.
  bool closed_out = false;
};

// Whether simbench-reconstruct lies beside the program: only where Embree and Open3D are.
bool has_reconstruction();

// A test with a folder of its own, which is also the program's working directory.
class ProgramTest : public testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& arguments,
                    const ProgramOptions& options = {}) const;

  // Writes a file into the folder and returns its name.
  std::string file(const std::string& name, const std::string& content) const;
  std::string content(const std::string& name) const;
  // Names in a folder below the test's, in alphabetical order.
  std::vector<std::string> names_in(const std::string& folder = ".") const;

  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  ScratchFolder folder_;
  ScratchFolder captures_;  // not in the folder: tests look at what is in that
};

}  // namespace simbench
