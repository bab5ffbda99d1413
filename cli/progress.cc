#include "cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/messages.h"
#include "recording/counted.h"

namespace simbench::cli {
namespace {

constexpr std::chrono::duration<double> kRedrawInterval{0.1};
constexpr std::chrono::duration<double> kEventInterval{0.125};
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

// A part of a whole, and the whole with its unit: "2" and "8 runs", "1.65" and "3.71 MB".
struct Amount {
  std::string part;
  std::string whole;
};

Amount amount(std::uint64_t part, std::uint64_t whole, const std::string& unit) {
  struct Prefix {
    double bytes;
    const char* unit;
  };
  constexpr Prefix kPrefixes[] = {{1e9, "GB"}, {1e6, "MB"}, {1e3, "kB"}};
  for (const Prefix& prefix : kPrefixes) {
    if (unit != "byte" || static_cast<double>(whole) < prefix.bytes) continue;
    return {fmt::format("{:.2f}", static_cast<double>(part) / prefix.bytes),
            fmt::format("{:.2f} {}", static_cast<double>(whole) / prefix.bytes, prefix.unit)};
  }
  return {std::to_string(part), counted(whole, unit)};
}

// Rounded to milliseconds; NaN is written as null.
double rounded_s(double seconds) { return std::round(seconds * 1000) / 1000; }

}  // namespace

ProgressStyle progress_style() {
  ProgressStyle style;
  style.json = messages_are_json();
  style.terminal = isatty(STDERR_FILENO) != 0 && takes_escapes();
  style.colour = style.terminal && wants_colour();
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) style.width = size.ws_col;
  return style;
}

Progress::Progress(std::ostream& out, ProgressStyle style, std::string unit, Clock clock)
    : out_(out), style_(style), unit_(std::move(unit)), clock_(std::move(clock)), start_(clock_()) {
  if (style_.json) out_ << event_line({{"event", "start"}, {"unit", unit_ + "s"}}) << std::flush;
}

std::chrono::duration<double> Progress::steady_seconds() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  if (finished_ || total == 0) return;
  done_ = done;
  total_ = total;
  if (style_.json) {
    print_event(done, total);
  } else if (style_.terminal) {
    if (was_just_drawn() && done < total) return;
    draw(static_cast<double>(done) / static_cast<double>(total), total, time_left(done, total));
  } else {
    print_line(done, total);
  }
}

void Progress::update(const evaluation::PartDone& parts) {
  if (finished_ || parts.total == 0) return;
  total_ = parts.total;
  part_left_s_ = parts.left_s;
  if (style_.json) {
    if (!std::isnan(parts.left_s)) print_event(done_, total_);
  } else if (!style_.terminal) {
    print_estimate(parts);
  } else if (!was_just_drawn()) {
    draw(parts.done / static_cast<double>(parts.total), parts.total, time_left(done_, total_));
  }
}

bool Progress::was_just_drawn() const { return drawn_ && clock_() - last_drawn_ < kRedrawInterval; }

// Once, and only of what is worth waiting for.
void Progress::print_estimate(const evaluation::PartDone& parts) {
  constexpr double kAMoment = 3;
  if (has_estimated_ || !(parts.left_s > kAMoment)) return;
  has_estimated_ = true;
  const double percent = 100 * parts.done / static_cast<double>(parts.total);
  out_ << fmt::format("about {} left, by the speed of the first {:.{}f} %\n",
                      duration_text(parts.left_s), percent, percent < 1 ? 1 : 0)
       << std::flush;
}

void Progress::finish() {
  if (style_.json && !finished_) print_last_event("end");
  erase();
}

void Progress::interrupt() {
  if (style_.json && !finished_) print_last_event("interrupt");
  erase();
}

void Progress::erase() {
  if (drawn_ && !finished_ && !style_.json) out_ << kEraseLine << std::flush;
  finished_ = true;
}

void Progress::print_event(std::uint64_t done, std::uint64_t total) {
  const std::chrono::duration<double> now = clock_();
  if (drawn_ && now - last_drawn_ < kEventInterval) return;
  out_ << event_line({{"event", "progress"},
                      {"done", done},
                      {"total", total},
                      {"unit", unit_ + "s"},
                      {"elapsed_s", rounded_s(elapsed_s())},
                      {"eta_s", rounded_s(left_s(done, total))}})
       << std::flush;
  last_drawn_ = now;
  drawn_ = true;
}

void Progress::print_last_event(const char* event) {
  out_ << event_line({{"event", event},
                      {"done", done_},
                      {"total", total_},
                      {"unit", unit_ + "s"},
                      {"elapsed_s", rounded_s(elapsed_s())}})
       << std::flush;
}

double Progress::left_s(std::uint64_t done, std::uint64_t total) const {
  if (part_left_s_) return *part_left_s_;
  if (done == 0) return std::numeric_limits<double>::quiet_NaN();
  return elapsed_s() * static_cast<double>(total - done) / static_cast<double>(done);
}

std::string Progress::time_left(std::uint64_t done, std::uint64_t total) const {
  const double left = left_s(done, total);
  return std::isnan(left) ? "" : fmt::format(", {} left", duration_text(left));
}

void Progress::draw(double share, std::uint64_t total, const std::string& left) {
  const std::string text = fmt::format("{:3.0f} % of {}{}", std::floor(100 * share),
                                       amount(0, total, unit_).whole, left);
  // A line that fills the last column would wrap on some terminals.
  const int room = style_.width - 1;
  const int bar = std::min(kWidestBar, room - static_cast<int>(text.size()) - 3);
  std::string line;
  if (bar >= kNarrowestBar) {
    const auto full = static_cast<int>(bar * share);
    line = fmt::format("[{}{}{}{}] ", style_.colour ? kGreen : "", std::string(full, '#'),
                       style_.colour ? kPlain : "", std::string(bar - full, '.'));
  }
  line += text.substr(0, static_cast<std::size_t>(std::max(room, 0)));
  out_ << kEraseLine << line << std::flush;
  last_drawn_ = clock_();
  drawn_ = true;
}

void Progress::print_line(std::uint64_t done, std::uint64_t total) {
  if (done * 4 < next_quarter_ * total) return;
  const std::uint64_t quarter = done * 4 / total;
  const auto [part, whole] = amount(done, total, unit_);
  if (quarter == 4) {
    out_ << fmt::format("{} in {}\n", whole, duration_text(elapsed_s()));
  } else {
    out_ << fmt::format("{} of {} ({} %){}\n", part, whole, done * 100 / total,
                        time_left(done, total));
  }
  out_ << std::flush;
  next_quarter_ = quarter + 1;
}

void print_interruption(const Watch& watch, std::uint64_t done, std::uint64_t total) {
  if (messages_are_json()) return;
  const auto [part, whole] = amount(done, total, watch.unit);
  std::cerr << fmt::format("interrupted after {} of {}; {}\n", part,
                           total ? whole : "all " + watch.unit + "s", watch.kept);
}

}  // namespace simbench::cli
