// One command line in a process of its own: forked, not executed anew, so that thousands of them
// take a minute.
//
//   const Ending ending = call({.arguments = {"simbench", "validate", "a.json"}});
//   if (const auto problem = problem_of(ending)) report(*problem);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace simbench::robustness {

inline constexpr double kMostSeconds = 10;
// From Ctrl-C to the end, in processor time: how loaded the machine is does not matter.
inline constexpr double kInterruptSeconds = 1;
inline constexpr std::uint64_t kMostBytes = 1U << 30U;

// Reading below this folder fails with EIO after so many bytes.
struct ReadFault {
  std::string folder;
  std::uint64_t after_bytes = 0;
};

struct Call {
  std::vector<std::string> arguments;  // the program's name first
  std::optional<double> interrupt_after_s{};
  std::optional<ReadFault> fault{};
};

struct Ending {
  int status = -1;  // -1: ended by a signal
  int signal = 0;
  double seconds = 0;
  std::optional<double> cpu_s_after_interrupt{};  // nothing: it was not interrupted
  std::uint64_t peak_bytes = 0;
  std::uint64_t failed_reads = 0;
  std::string output;    // standard output
  std::string messages;  // standard error
};

// Kills what takes much longer than it may.
Ending call(const Call& call);

// What is wrong with an ending: a signal, an internal error, too long, too large, an error without
// a message, a Ctrl-C that was not heard, a failed read that was taken for the end of a file, and
// nan or inf in the output unless `input` has them as well. Nothing: it is fine.
std::optional<std::string> problem_of(const Ending& ending, const std::string& input = "");

}  // namespace simbench::robustness
