// The progress of work on standard error, and a way to run long, interruptible work.
//
// On a terminal: one line with a bar and the remaining time, redrawn at most ten times a second,
// never wider than the terminal, erased at the end. Elsewhere (a file, a log): a line at the start
// and one at every quarter. Colour only on a terminal that has it, if wanted (cli/messages.h).
//
// Where real programs run, within runs too: the bar moves, and what is left is by the speed
// measured so far (evaluation/run/part_progress.h). Elsewhere a line states it once it is known, if
// it is more than a moment.
//
// Work that is counted in bytes shows them in the unit that suits the whole: "1.65 of 3.71 MB".
//
// With --json (cli/messages.h) JSON lines, at most eight of progress a second; "eta_s" is null
// before the first unit is done:
//
//   {"event":"start","unit":"runs"}
//   {"event":"progress","done":12,"total":96,"unit":"runs","elapsed_s":1.31,"eta_s":9.17}
//   {"event":"end","done":96,"total":96,"unit":"runs","elapsed_s":10.4}
//
// and, after Ctrl-C, {"event":"interrupt", ...} with the same members in place of the last. Work
// that fails ends with an "error" instead.
//
//   Progress progress(std::cerr, progress_style(), "run");
//   evaluate(scenario, make_source, options,
//            [&](auto done, auto total) { progress.update(done, total); });
//   progress.finish();
//
// Not thread-safe: one call at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <iostream>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>

#include "app/interrupt.h"
#include "cli/embedding.h"
#include "cli/interrupt_deadline.h"
#include "evaluation/run/evaluate.h"

namespace simbench::cli {

struct ProgressStyle {
  bool json = false;
  bool terminal = false;
  bool colour = false;
  int width = 80;  // of the terminal, in columns
};

// The style for standard error: terminal or not, its width, colour; and --json.
ProgressStyle progress_style();

class Progress {
 public:
  using Clock = std::function<std::chrono::duration<double>()>;

  // `unit`: what is counted, in the singular. `clock` counts seconds from any zero.
  Progress(std::ostream& out, ProgressStyle style, std::string unit, Clock clock = steady_seconds);
  ~Progress() { erase(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint64_t done, std::uint64_t total);
  // Between two of these: a run is under way.
  void update(const evaluation::PartDone& parts);
  // The work is done, or was interrupted. Erases the bar; later updates are ignored.
  void finish();
  void interrupt();

 private:
  static std::chrono::duration<double> steady_seconds();
  double elapsed_s() const { return (clock_() - start_).count(); }
  double left_s(std::uint64_t done, std::uint64_t total) const;
  std::string time_left(std::uint64_t done, std::uint64_t total) const;
  void erase();
  void print_event(std::uint64_t done, std::uint64_t total);
  void print_last_event(const char* event);
  // `share` of the total.
  void draw(double share, std::uint64_t total, const std::string& left);
  void print_line(std::uint64_t done, std::uint64_t total);
  void print_estimate(const evaluation::PartDone& parts);
  bool was_just_drawn() const;

  std::ostream& out_;
  ProgressStyle style_;
  std::string unit_;
  Clock clock_;
  std::chrono::duration<double> start_;
  std::chrono::duration<double> last_drawn_{-1};
  std::uint64_t next_quarter_ = 0;
  std::uint64_t done_ = 0;
  std::uint64_t total_ = 0;
  // As last measured within runs, NaN before; nothing: nobody tells.
  std::optional<double> part_left_s_;
  bool has_estimated_ = false;
  bool drawn_ = false;
  bool finished_ = false;
};

// How watched() reports its work.
struct Watch {
  std::string unit = "run";                    // what it counts, in the singular
  std::uint64_t total = 0;                     // how many; 0: unknown until it begins
  std::string kept = "no result was written";  // what an interruption leaves
  // Whether an interruption waits until the work has ended in order, however long that takes, but
  // for a second one: a rig's cameras and trigger must be switched off, a recording's end noted.
  bool waits_for_end = false;
};

// Reports the first Ctrl-C.
void print_interruption(const Watch& watch, std::uint64_t done, std::uint64_t total);

// watched() of an embedded command (cli/embedding.h): its owner is told, and interrupts.
template <class Result, class Work>
std::optional<Result> watched_by(const Embedding& owner, const Work& work) {
  try {
    evaluation::Progress report = [&owner](std::uint64_t done, std::uint64_t total) {
      if (owner.progress) owner.progress(done, total);
    };
    return work(report);
  } catch (const std::exception&) {
    if (!app::InterruptHandler::raised()) throw;
  }
  return std::nullopt;
}

// Runs the work of a long command, with progress, until its end or the first Ctrl-C.
//
// After Ctrl-C the work ends soon (cli/interrupt_deadline.h); a line reports how far it got, and
// there is no result. With --json all messages are JSON lines.
//
//   const auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
//     return evaluation::evaluate(scenario, make_source, options, progress);
//   });
//   if (!results) return kInterrupted;
//
// `work` returns a Result, or an empty std::optional. Its exceptions pass through, unless it was
// interrupted.
template <class Result, class Work>
std::optional<Result> watched(const Work& work, const Watch& watch = {}) {
  if (const Embedding* const within = embedding()) return watched_by<Result>(*within, work);
  const app::InterruptHandler handler;
  Progress progress(std::cerr, progress_style(), watch.unit);
  std::mutex mutex;  // guards what follows, and `progress`
  std::uint64_t finished = 0;
  std::uint64_t all = watch.total;
  const auto report_interruption = [&] {
    const std::lock_guard lock(mutex);
    progress.interrupt();
    print_interruption(watch, finished, all);
  };
  try {
    using Patience = InterruptDeadline::Patience;
    std::optional<InterruptDeadline> deadline;
    deadline.emplace(report_interruption,
                     watch.waits_for_end ? Patience::kUntilInsisted : Patience::kMoment);
    evaluation::Progress report = [&](std::uint64_t done, std::uint64_t total) {
      const std::lock_guard lock(mutex);
      finished = done;
      all = total;
      progress.update(done, total);
    };
    report.on_part = [&](const evaluation::PartDone& parts) {
      const std::lock_guard lock(mutex);
      progress.update(parts);
    };
    std::optional<Result> result = work(report);
    deadline.reset();
    progress.finish();
    return result;
  } catch (const std::exception&) {
    if (!app::InterruptHandler::raised()) throw;
  }
  report_interruption();
  return std::nullopt;
}

}  // namespace simbench::cli
