// How far the work is, on standard error; and how long work is run, which may be interrupted.
//
// On a terminal: one line with a bar and the time still to go, redrawn at most ten times a second,
// never wider than the terminal, erased at the end. Elsewhere (a file, a log): a line at the start
// and one at every quarter. Colour only on a terminal that has it and where it is wanted
// (cli/messages.h).
//
// With --json (cli/messages.h) JSON lines, eight of progress a second at most; "eta_s" is null
// while nothing is done:
//
//   {"event":"start","unit":"runs"}
//   {"event":"progress","done":12,"total":96,"unit":"runs","elapsed_s":1.31,"eta_s":9.17}
//   {"event":"end","done":96,"total":96,"unit":"runs","elapsed_s":10.4}
//
// and in place of the last, after Ctrl-C, {"event":"interrupt", ...} with the same members. Work
// that fails ends with neither, but with an "error".
//
//   Progress progress(std::cerr, progress_style(), "runs");
//   evaluate(scenario, make_source, options,
//            [&](auto done, auto total) { progress.update(done, total); });
//   progress.finish();
//
// Not thread-safe: one call at a time.
#ifndef SIMBENCH_CLI_PROGRESS_H_
#define SIMBENCH_CLI_PROGRESS_H_

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <iostream>
#include <optional>
#include <ostream>
#include <string>

#include "app/interrupt.h"
#include "evaluation/run/evaluate.h"

namespace simbench::cli {

struct ProgressStyle {
  bool json = false;
  bool terminal = false;
  bool colour = false;
  int width = 80;  // of the terminal, in columns
};

// What standard error is: terminal or not, its width, whether it takes colour; and --json.
ProgressStyle progress_style();

class Progress {
 public:
  using Clock = std::function<std::chrono::duration<double>()>;

  // `clock` counts seconds from any zero; a test brings its own.
  Progress(std::ostream& out, ProgressStyle style, std::string unit, Clock clock = steady_seconds);
  ~Progress() { erase(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint64_t done, std::uint64_t total);
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
  void draw(std::uint64_t done, std::uint64_t total);
  void print_line(std::uint64_t done, std::uint64_t total);

  std::ostream& out_;
  ProgressStyle style_;
  std::string unit_;
  Clock clock_;
  std::chrono::duration<double> start_;
  std::chrono::duration<double> last_drawn_{-1};
  std::uint64_t next_quarter_ = 0;
  std::uint64_t done_ = 0;
  std::uint64_t total_ = 0;
  bool drawn_ = false;
  bool finished_ = false;
};

// What watched() says about its work.
struct Watch {
  std::string unit = "runs";                   // what it counts, in the plural
  std::uint64_t total = 0;                     // of them; 0: known only once it has begun
  std::string kept = "no result was written";  // what an interruption leaves
};

// After the first Ctrl-C.
void print_interruption(const Watch& watch, std::uint64_t done, std::uint64_t total);

// Runs work that reports its progress and may be interrupted, the way every long command does.
//
// After the first Ctrl-C the work ends at its next run; then a line says how far it got, and there
// is no result. With --json all of it is JSON lines; a command needs to do nothing for that but run
// its work in here.
//
//   const auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
//     return evaluation::evaluate(scenario, make_source, options, progress);
//   });
//   if (!results) return kInterrupted;
//
// `work` returns a Result (or none: an empty std::optional). Everything that it throws passes
// through, unless it was interrupted.
template <class Result, class Work>
std::optional<Result> watched(const Work& work, const Watch& watch = {}) {
  const app::InterruptHandler handler;
  Progress progress(std::cerr, progress_style(), watch.unit);
  std::uint64_t finished = 0;
  std::uint64_t all = watch.total;
  try {
    std::optional<Result> result = work([&](std::uint64_t done, std::uint64_t total) {
      finished = done;
      all = total;
      progress.update(done, total);
    });
    progress.finish();
    return result;
  } catch (const std::exception&) {
    if (!app::InterruptHandler::raised()) throw;
  }
  progress.interrupt();
  print_interruption(watch, finished, all);
  return std::nullopt;
}

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_PROGRESS_H_
