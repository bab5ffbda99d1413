// The last resort of Ctrl-C: work that goes on after it is ended with its program.
//
// Work that polls app::InterruptHandler ends by itself and in order. What polls too rarely - a
// world of a million hosts that is being built, an algorithm of a user's own - is not waited for:
// somewhat less than a second after the signal, or soon after a second one, a report is made, what
// is half-written is removed (recording/disposable.h), and the program ends with
// ExitStatus::kInterrupted.
//
// While this lives, an InterruptHandler must.
//
//   const app::InterruptHandler handler;
//   {
//     const InterruptDeadline deadline([] { print_note("interrupted"); });
//     use();
//   }
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace simbench::cli {

class InterruptDeadline {
 public:
  // How long the work may go on.
  enum class Patience : std::uint8_t { kMoment, kUntilInsisted };

  // `report` is called on another thread, beside the work. Without a thread there is no deadline.
  explicit InterruptDeadline(std::function<void()> report, Patience patience = Patience::kMoment);
  InterruptDeadline(const InterruptDeadline&) = delete;
  InterruptDeadline& operator=(const InterruptDeadline&) = delete;
  // The work is over. Does not return if the deadline has passed already.
  ~InterruptDeadline() = default;

 private:
  void watch(const std::stop_token& over);

  std::function<void()> report_;
  Patience patience_;
  std::mutex mutex_;  // only for the condition
  std::condition_variable_any condition_;
  std::jthread watcher_;  // last: uses the others
};

}  // namespace simbench::cli
