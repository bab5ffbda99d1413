// Reads the time stamps of a TICC, a counter of two channels that stamps the pulses of clocks.
#include <algorithm>
#include <array>
#include <cmath>

#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

// "17.123456789012 chA": seconds of the counter, and which channel.
//
// A pulse is due whole seconds after the channel's first one, so that the fractions of a second
// alone have the time error: picoseconds are left even after years.
class TiccLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() != 2) return std::nullopt;
    const auto channel = std::ranges::find(kChannels, words[1]);
    if (channel == kChannels.end()) return std::nullopt;
    const std::size_t point = words[0].find('.');
    const std::optional<Microseconds> time = microseconds_of(words[0]);
    if (!time || point == std::string_view::npos) return std::nullopt;
    const double fraction_s = finite_of(words[0].substr(point), "fraction of a second", 1, place);
    std::optional<double>& first_s =
        first_s_[static_cast<std::size_t>(channel - kChannels.begin())];
    if (!first_s) first_s = fraction_s;
    const double late_s = std::remainder(fraction_s - *first_s, 1.0);
    if (std::abs(late_s) > kLatestS) return skip();
    return LogLine{.format = "ticc", .name = *channel, .point = {*time, 0 - late_s}};
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes = {
        "time errors count from the first pulse of each channel, pulses are due once a second"};
    if (skipped() > 0) {
      notes.push_back(counted(skipped(), "pulse") +
                      " more than 0.25 s from a whole second after the first left out");
    }
    return notes;
  }
  bool absolute() const override { return false; }

 private:
  static constexpr std::array<std::string_view, 2> kChannels = {"chA", "chB"};
  static constexpr double kLatestS = 0.25;

  std::array<std::optional<double>, 2> first_s_{};
};

}  // namespace

std::unique_ptr<LogLines> ticc_lines() { return std::make_unique<TiccLines>(); }

}  // namespace simbench::evaluation
