// Ctrl-C and SIGTERM, which stop jobs at their next frames or after some thousand events of their
// world, and the simulator with it: the worlds that the command line runs.
//
//   InterruptHandler handler;                     // while it lives, they raise a flag
//   evaluate(scenario, [&] { return simulated_world(scenario); }, options, progress);
//   if (InterruptHandler::raised()) return kInterrupted;
//
// The flag stays raised: a signal that came when one piece of work had already ended stops the next
// one. A second signal raises another flag, on which cli/interrupt_deadline.h ends the program at
// once; a third does so itself. A program that has signal handlers of its own raises the flag in
// their place.
#pragma once

#include <array>
#include <atomic>
#include <csignal>
#include <memory>

#include "recording/clock_source.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// The signals that interrupt work: of the terminal, and of a job's end.
inline constexpr std::array kInterruptions = {SIGINT, SIGTERM};

// One at a time: signal handlers belong to the process. While it lives, its thread does not hold
// them back (reports/text/output_file.h).
class InterruptHandler {
 public:
  InterruptHandler();
  ~InterruptHandler();
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;
  static bool raised();
  // A second signal came: whoever sent it does not want to wait.
  static bool insisted();
  // The flag itself, for work that polls one.
  static const std::atomic<bool>& flag();
  // In place of a signal, for a program with handlers of its own; set(false) before the next work.
  static void set(bool raised);

 private:
  std::array<struct sigaction, kInterruptions.size()> previous_{};
  sigset_t previous_mask_ = {};
};

// The same source, but record() throws RecordingCancelled once the flag is raised.
std::unique_ptr<RecordingSource> interruptible(std::unique_ptr<RecordingSource> source);

// The simulator, interruptible: an evaluation::WorldFactory. `scenario` outlives the result.
std::unique_ptr<RecordingSource> simulated_world(const scenarios::Scenario& scenario);
// The simulator of the hosts' clocks alone, interruptible too: an evaluation::ClockWorldFactory.
std::unique_ptr<ClockSource> simulated_clocks(const scenarios::Scenario& scenario);

}  // namespace simbench::app
