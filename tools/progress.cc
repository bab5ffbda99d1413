#include "tools/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace simbench::tools {
namespace {

constexpr std::chrono::duration<double> kRedrawInterval{0.1};
constexpr int kWidestBar = 40;
constexpr int kNarrowestBar = 8;
constexpr const char* kEraseLine = "\r\x1b[K";
constexpr const char* kGreen = "\x1b[32m";
constexpr const char* kPlain = "\x1b[0m";

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

ProgressStyle terminal_style() {
  ProgressStyle style;
  const char* term = std::getenv("TERM");
  style.terminal = isatty(STDERR_FILENO) != 0 && term != nullptr && std::strcmp(term, "dumb") != 0;
  style.colour = style.terminal && !is_set("NO_COLOR");
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) style.width = size.ws_col;
  return style;
}

Progress::Progress(std::ostream& out, ProgressStyle style, std::string unit, Clock clock)
    : out_(out),
      style_(style),
      unit_(std::move(unit)),
      clock_(std::move(clock)),
      start_(clock_()) {}

std::chrono::duration<double> Progress::steady_seconds() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  if (finished_ || total == 0) return;
  if (style_.terminal) {
    draw(done, total);
  } else {
    print_line(done, total);
  }
}

void Progress::finish() {
  if (drawn_ && !finished_) out_ << kEraseLine << std::flush;
  finished_ = true;
}

std::string Progress::time_left(std::uint64_t done, std::uint64_t total) const {
  if (done == 0) return "";
  const double elapsed = (clock_() - start_).count();
  const double left = elapsed * static_cast<double>(total - done) / static_cast<double>(done);
  return fmt::format(", {} left", duration_text(left));
}

void Progress::draw(std::uint64_t done, std::uint64_t total) {
  const std::chrono::duration<double> now = clock_();
  if (drawn_ && now - last_drawn_ < kRedrawInterval && done < total) return;
  const std::string text =
      fmt::format("{:3} % of {} {}{}", done * 100 / total, total, unit_, time_left(done, total));
  // A line that fills the last column would wrap on some terminals.
  const int room = style_.width - 1;
  const int bar = std::min(kWidestBar, room - static_cast<int>(text.size()) - 3);
  std::string line;
  if (bar >= kNarrowestBar) {
    const auto full = static_cast<int>(static_cast<std::uint64_t>(bar) * done / total);
    line = fmt::format("[{}{}{}{}] ", style_.colour ? kGreen : "", std::string(full, '#'),
                       style_.colour ? kPlain : "", std::string(bar - full, '.'));
  }
  line += text.substr(0, static_cast<std::size_t>(std::max(room, 0)));
  out_ << kEraseLine << line << std::flush;
  last_drawn_ = now;
  drawn_ = true;
}

void Progress::print_line(std::uint64_t done, std::uint64_t total) {
  if (done * 4 < next_quarter_ * total) return;
  const std::uint64_t quarter = done * 4 / total;
  if (quarter == 4) {
    out_ << fmt::format("{} {} in {}\n", total, unit_, duration_text((clock_() - start_).count()));
  } else {
    out_ << fmt::format("{} of {} {} ({} %){}\n", done, total, unit_, done * 100 / total,
                        time_left(done, total));
  }
  out_ << std::flush;
  next_quarter_ = quarter + 1;
}

}  // namespace simbench::tools
