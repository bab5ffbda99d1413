// Ctrl-C: stops the jobs at their next frame instead of in the middle of something.
//
//   InterruptHandler handler;                     // while it lives, SIGINT raises a flag
//   evaluate(
//       scenario, [&] { return interruptible(make_simulation(scenario)); }, options, progress);
//   if (InterruptHandler::raised()) return kInterrupted;
//
// A second SIGINT ends the program at once, as it always did.
#ifndef SIMBENCH_APP_INTERRUPT_H_
#define SIMBENCH_APP_INTERRUPT_H_

#include <atomic>
#include <csignal>
#include <exception>
#include <memory>

#include "recording/recording.h"

namespace simbench::app {

// One at a time: signal handlers belong to the process.
class InterruptHandler {
 public:
  InterruptHandler();
  ~InterruptHandler();
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;
  static bool raised();
  // What is raised: for work that looks at a flag of its caller's.
  static const std::atomic<bool>& flag();

 private:
  struct sigaction previous_ = {};
};

class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

// The same source, but record() throws Interrupted once the flag is raised.
std::unique_ptr<RecordingSource> interruptible(std::unique_ptr<RecordingSource> source);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_INTERRUPT_H_
