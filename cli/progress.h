// How far the work is, on standard error.
//
// On a terminal: one line with a bar and the time still to go, redrawn at most ten times a second,
// never wider than the terminal, erased at the end. Elsewhere (a file, a log): a line at the start
// and one at every quarter. Colour only on a terminal that has it and where it is wanted
// (cli/terminal.h).
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
#include <functional>
#include <ostream>
#include <string>

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

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_PROGRESS_H_
