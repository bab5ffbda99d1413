// How far the work is, on standard error.
//
// On a terminal: one line with a bar and the time still to go, redrawn at most ten times a second,
// never wider than the terminal, erased at the end. Elsewhere (a file, a log): a line at the start
// and one at every quarter. Colour only on a terminal that has it, and never with NO_COLOR set
// (no-color.org).
//
//   Progress progress(std::cerr, terminal_style(), "runs");
//   evaluate(..., [&](auto done, auto total) { progress.update(done, total); });
//   progress.finish();
//
// Not thread-safe: one call at a time.
#ifndef SIMBENCH_TOOLS_PROGRESS_H_
#define SIMBENCH_TOOLS_PROGRESS_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

namespace simbench::tools {

struct ProgressStyle {
  bool terminal = false;
  bool colour = false;
  int width = 80;  // of the terminal, in columns
};

// What standard error is: terminal or not, its width, NO_COLOR and TERM.
ProgressStyle terminal_style();

class Progress {
 public:
  using Clock = std::function<std::chrono::duration<double>()>;

  // `clock` counts seconds from any zero; a test brings its own.
  Progress(std::ostream& out, ProgressStyle style, std::string unit, Clock clock = steady_seconds);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint64_t done, std::uint64_t total);
  // Erases the bar. Later updates are ignored.
  void finish();

 private:
  static std::chrono::duration<double> steady_seconds();
  std::string time_left(std::uint64_t done, std::uint64_t total) const;
  void draw(std::uint64_t done, std::uint64_t total);
  void print_line(std::uint64_t done, std::uint64_t total);

  std::ostream& out_;
  ProgressStyle style_;
  std::string unit_;
  Clock clock_;
  std::chrono::duration<double> start_;
  std::chrono::duration<double> last_drawn_{-1};
  std::uint64_t next_quarter_ = 0;
  bool drawn_ = false;
  bool finished_ = false;
};

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_PROGRESS_H_
