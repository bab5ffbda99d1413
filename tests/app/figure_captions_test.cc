// What the captions of figures state, in 20 seeds, against computations of their own: from the
// recording, from the scores, and from what is drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <regex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/figure_source.h"
#include "evaluation/run/run_detail.h"
#include "reports/figures/result_figures.h"
#include "reports/figures/run_figures.h"
#include "reports/figures/seed_figures.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"
#include "tests/recording/test_sink.h"

namespace simbench::app {
namespace {

using evaluation::RunDetail;
using reports::Figure;
using ::testing::HasSubstr;

constexpr std::uint64_t kSeeds = 20;
// A duration in a caption, and three digits of it: half of the last one is below half a percent.
const std::string kTime = "([+-]?[0-9.]+(?:e-?[0-9]+)? (?:ns|us|ms|s)|0|-)";
constexpr double kDigits = 0.0051;

double ms_of_text(const std::string& text) {
  if (text == "0") return 0;
  static const std::map<std::string, double> units = {
      {"ns", 1e-6}, {"us", 1e-3}, {"ms", 1}, {"s", 1e3}};
  const std::size_t blank = text.find(' ');
  return std::stod(text.substr(0, blank)) * units.at(text.substr(blank + 1));
}

// The parts of the caption that the groups of the pattern match; fails without.
std::vector<std::string> stated(const Figure& figure, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(figure.caption, match, std::regex(pattern))) {
    ADD_FAILURE() << "no '" << pattern << "' in: " << figure.caption;
    return std::vector<std::string>(9, "0");
  }
  return {std::next(match.begin()), match.end()};
}

void expect_stated(const std::string& text, double ms, double within_ms = 1e-9) {
  EXPECT_NEAR(ms_of_text(text), ms, std::abs(ms) * kDigits + within_ms);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct World {
  explicit World(const std::string& name, std::vector<scenarios::Override> changes = {})
      : scenario(scenarios::load_scenario(name, changes)), source(sim::make_simulation(scenario)) {}

  evaluation::PipelineChoice choice(const std::string& pipeline) const {
    return evaluation::choose_pipelines(scenario, {pipeline}).front();
  }
  RunDetail run(const std::string& pipeline, std::uint64_t seed) const {
    return evaluation::run_detail(scenario, choice(pipeline), seed, *source);
  }

  scenarios::Scenario scenario;
  std::unique_ptr<RecordingSource> source;
};

struct Mean {
  double sum = 0;
  double count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return sum / count; }
};

// Hosts' means over the evaluated pulses, straight from the recording.
class HostMeans final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override { layout_ = layout; }
  void on_event(const RecordingEvent& event) override {
    const auto* pulse = std::get_if<PulseTruth>(&event);
    if (pulse == nullptr || !counts(pulse->pulse)) return;
    for (std::size_t host = 0; host < pulse->host_errors.size(); ++host) {
      clock_ms[host].add(to_ms(pulse->host_errors[host]));
    }
  }

  std::map<std::size_t, Mean> clock_ms;
  std::map<std::size_t, Mean> exposure_ms;  // true mid-exposures since the first of all
  std::map<std::size_t, Mean> length_ms;
  std::map<std::size_t, Mean> delay_ms;  // arrivals after mid-exposure, on the host's clock

 private:
  bool counts(std::int64_t pulse) const {
    return pulse >= layout_.first_pulse && pulse < layout_.first_pulse + layout_.pulses;
  }
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    if (!counts(truth->pulse)) return;
    const std::size_t host = layout_.cameras[frame.camera].host;
    const double period_ms = 1000 / layout_.frame_rate_hz;
    exposure_ms[host].add(to_ms(truth->mid_exposure().time_since_epoch()) -
                          static_cast<double>(truth->pulse) * period_ms);
    length_ms[host].add(to_ms(truth->exposure_end - truth->exposure_start));
    delay_ms[host].add(to_ms(frame.arrival - truth->own_host));
  }

  RigLayout layout_;
};

// The means of a panel's curves, by the colour, which is the host.
std::map<std::size_t, Mean> drawn_hosts(const reports::FigurePanel& panel) {
  std::map<std::size_t, Mean> hosts;
  for (const reports::FigureSeries& series : nonempty(panel.series)) {
    for (const double y : series.y) hosts[static_cast<std::size_t>(series.colour)].add(y);
  }
  return hosts;
}

const std::string kDistance = "hosts (\\d+) and (\\d+), the farthest, are " + kTime +
                              " apart: " + kTime + " by their clocks, " + kTime +
                              " by the middles of their exposures \\(" + kTime + " and " + kTime +
                              " long\\), " + kTime + " by the delay from there to the stamp";

TEST(FigureCaptionsTest, WhatSeparatesTheHostsOfFig5IsWhatTheRecordingSays) {
  struct Case {
    std::string scenario;
    std::string pipeline;
  };
  for (const Case& each :
       {Case{"6cam_2host_30fps", "ntp_last_set"}, Case{"18cam_6host_45fps", "ntp_last_set"},
        Case{"18cam_6host_45fps", "yoon2021_both"}}) {
    const World world(each.scenario);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(each.scenario + " " + each.pipeline + " " + std::to_string(seed));
      const Figure figure = reports::hosts(world.run(each.pipeline, seed));
      HostMeans means;
      evaluation::record_run(*world.source, world.choice(each.pipeline), seed, means);
      const std::vector<std::string> said = stated(figure, kDistance);
      const std::size_t first = std::stoul(said[0]);
      const std::size_t last = std::stoul(said[1]);
      ASSERT_NE(first, last);
      const auto apart = [&](std::map<std::size_t, Mean>& hosts) {
        return hosts[last].value() - hosts[first].value();
      };
      std::map<std::size_t, Mean> drawn = drawn_hosts(figure.panels.back());
      expect_stated(said[2], apart(drawn));
      EXPECT_GT(apart(drawn), 0);
      expect_stated(said[3], apart(means.clock_ms), 1e-3);
      expect_stated(said[4], apart(means.exposure_ms), 1e-3);
      expect_stated(said[5], means.length_ms[first].value());
      expect_stated(said[6], means.length_ms[last].value());
      // A regression over 30 frames follows arrivals, whose jitter is a few hundredths of a ms.
      expect_stated(said[7], apart(means.delay_ms), 0.05);
    }
  }
}

TEST(FigureCaptionsTest, TheErrorOfTheClocksIsNotWhatSeparatesTheFirstTwoHostsAtTheDefaultSeed) {
  const Figure figure = reports::hosts(World("18cam_6host_45fps").run("yoon2021_both", 1));
  const std::vector<std::string> said = stated(figure, kDistance);
  EXPECT_LT(std::abs(ms_of_text(said[3])), 0.05);
  EXPECT_GT(std::abs(ms_of_text(said[4])), 1);
  EXPECT_THAT(figure.caption, HasSubstr("not yet synchronised: ntp_last_set"));
}

TEST(FigureCaptionsTest, RangesInHostsOfFig8AreThoseOfTheScores) {
  const World world("18cam_6host_45fps");
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<RunDetail> runs = {world.run("ntp_last_set", seed),
                                         world.run("yoon2021_both", seed)};
    const Figure figure = reports::synchronisation(runs);
    for (const auto& [what, run] : {std::pair{"Without", &runs[0]}, std::pair{"With", &runs[1]}}) {
      SCOPED_TRACE(run->pipeline + " " + std::to_string(seed));
      const std::vector<std::string> said =
          stated(figure, std::string(what) + " \\(" + run->pipeline +
                             "\\): Means over the pulses: the stamps of one host lie within " +
                             kTime + "; " + kDistance);
      expect_stated(said[0], run->score.spread_in_host_ms, 1e-6);
      // The farthest hosts in the mean are not farther than the mean of the farthest.
      EXPECT_LE(ms_of_text(said[3]), run->score.spread_between_hosts_ms * (1 + kDigits));
      std::map<std::size_t, Mean> drawn = drawn_hosts(figure.panels[run == &runs[0] ? 0 : 1]);
      double least = 1e9;
      double most = -1e9;
      for (const auto& [host, mean] : nonempty(drawn)) {
        least = std::min(least, mean.value());
        most = std::max(most, mean.value());
      }
      expect_stated(said[3], most - least);
    }
  }
}

double deviation(const std::vector<double>& values) {
  Mean mean;
  for (const double value : values) mean.add(value);
  double squares = 0;
  for (const double value : values) squares += std::pow(value - mean.value(), 2);
  return std::sqrt(squares / (mean.count - 1));
}

// The stamps of the paper's Fig. 2 of camera 0 after the warm-up, straight from the recording.
class FourStamps final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override { first_pulse_ = layout.first_pulse; }
  std::map<std::string, std::vector<double>> stamps_ms;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    if (frame.camera != 0 || truth->pulse < first_pulse_) return;
    stamps_ms["sensor"].push_back(frame.sensor.us * 1e-3);
    stamps_ms["frame"].push_back(frame.frame.us * 1e-3);
    stamps_ms["back-end"].push_back(to_ms(frame.backend.time_since_epoch()));
    stamps_ms["arrival"].push_back(to_ms(frame.arrival.time_since_epoch()));
  }
  std::int64_t first_pulse_ = 0;
};

TEST(FigureCaptionsTest, IntervalsOfFig2VaryAsStated) {
  for (const auto& [name, jumps] :
       {std::pair{"18cam_6host_45fps", false}, std::pair{"18cam_6host_45fps_lan", true}}) {
    const World world(name);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(name + (" " + std::to_string(seed)));
      const Figure figure = reports::stamp_intervals(world.run("yoon2021_both", seed));
      FourStamps four;
      evaluation::record_run(*world.source, world.choice("yoon2021_both"), seed, four);
      const std::vector<std::string> said =
          stated(figure, "sensor " + kTime + ", frame " + kTime + ", back-end " + kTime +
                             ", arrival " + kTime + "; (\\d+) of (\\d+) arrival intervals");
      int place = 0;
      for (const std::string stamp : {"sensor", "frame", "back-end", "arrival"}) {
        std::vector<double> intervals = four.stamps_ms[stamp];
        std::adjacent_difference(intervals.begin(), intervals.end(), intervals.begin());
        intervals.erase(intervals.begin());
        // The wrap of the camera's register is no interval.
        std::erase_if(intervals, [](double interval) { return interval < -1e6; });
        expect_stated(said[place++], deviation(intervals), 1e-4);
        if (stamp != "arrival") continue;
        EXPECT_EQ(std::stol(said[4]), std::ranges::count_if(intervals, [](double interval) {
                    return interval > 1.1 * 1000 / 45.0;
                  }));
        EXPECT_EQ(std::stoul(said[5]), intervals.size());
      }
      EXPECT_EQ(std::stol(said[4]) > 0, jumps);
      EXPECT_EQ(contains(figure.caption, "also has rare large jumps"), !jumps);
    }
  }
}

TEST(FigureCaptionsTest, TheFirstSecondsOfFig7AreUnsteadyWhereStated) {
  for (const auto& [name, unsteady] :
       {std::pair{"18cam_6host_45fps", false}, std::pair{"18cam_6host_45fps_lan", true}}) {
    const World world(name);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(name + (" " + std::to_string(seed)));
      const Figure figure = reports::first_seconds(world.run("yoon2021_both", seed));
      const std::vector<std::string> said =
          stated(figure, "intervals: " + kTime + " from 2 to 5 s, " + kTime + " later");
      std::vector<double> before;
      std::vector<double> after;
      for (const reports::FigureSeries& series : nonempty(figure.panels.front().series)) {
        for (std::size_t i = 0; i < series.x.size(); ++i) {
          if (series.x[i] >= 2) (series.x[i] < 5 ? before : after).push_back(series.y[i]);
        }
      }
      expect_stated(said[0], deviation(before));
      expect_stated(said[1], deviation(after));
      EXPECT_EQ(deviation(before) > 2 * deviation(after), unsteady);
      EXPECT_EQ(contains(figure.caption, "also has unsteady intervals"), !unsteady);
      expect_stated(stated(figure, "Scores begin after " + kTime)[0], 5000, 30);
    }
  }
}

TEST(FigureCaptionsTest, RangesOfFig3AndDifferencesOfFig4AreThoseDrawn) {
  const World world("3cam_1host_30fps");
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const RunDetail run = world.run("free_running", seed);
    const Figure stamps = reports::stamps(run);
    const std::vector<std::string> said =
        stated(stamps, "are " + kTime + " apart on the cameras' own clocks, and " + kTime + " \\(" +
                           kTime + " at most\\) by their arrivals");
    for (const std::size_t panel : {0U, 1U}) {
      const std::vector<reports::FigureSeries>& series = stamps.panels[panel].series;
      ASSERT_EQ(series.size(), 3U);
      Mean mean;
      double largest = 0;
      for (std::size_t i = 0; i < nonempty(series[0].y).size(); ++i) {
        const auto [least, most] = std::minmax({series[0].y[i], series[1].y[i], series[2].y[i]});
        mean.add(most - least);
        largest = std::max(largest, most - least);
      }
      expect_stated(said[panel], mean.value());
      if (panel == 1) expect_stated(said[2], largest);
    }
    const Figure global = reports::global_stamps(run);
    const std::vector<std::string> differ =
        stated(global, "differ by " + kTime + " on average, " + kTime + " at most");
    Mean mean;
    double largest = 0;
    for (std::size_t s = 0; s < 3; ++s) {
      const std::vector<double>& online = global.panels[0].series[s].y;
      const std::vector<double>& offline = global.panels[1].series[s].y;
      for (std::size_t i = 0; i < nonempty(online).size(); ++i) {
        mean.add(std::abs(online[i] - offline[i]));
        largest = std::max(largest, std::abs(online[i] - offline[i]));
      }
    }
    expect_stated(differ[0], mean.value(), 1e-6);
    expect_stated(differ[1], largest, 1e-6);
  }
}

TEST(FigureCaptionsTest, TheTrendOfFig10IsThatOfTheScores) {
  const scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_45fps");
  const std::vector<std::string> paper = {"ntp_last_set", "yoon2021_network", "yoon2021_time",
                                          "yoon2021_both"};
  FigureOptions options = {.pipelines = paper, .figures = {"fig10"}};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) options.seeds.push_back(seed);
  const ArchiveFigures made = scenario_figures(scenario, options, 1);
  ASSERT_EQ(made.figures.size(), kSeeds);
  const World world("18cam_6host_45fps");
  for (const Figure& figure : made.figures) {
    SCOPED_TRACE(*figure.seed);
    EXPECT_EQ(figure.paper, "Fig. 10");
    const std::vector<std::string> said =
        stated(figure, "AMD of (\\w+) changes most .*, by ([+-][0-9.]+) % of its mean");
    double largest = 0;
    std::string pipeline;
    for (const std::string& name : paper) {
      const evaluation::SeedScore score = world.run(name, *figure.seed).score;
      const double change = score.trend_ms / score.amd_ms * 100;
      if (std::abs(change) <= std::abs(largest)) continue;
      largest = change;
      pipeline = name;
    }
    EXPECT_EQ(said[0], pipeline);
    EXPECT_NEAR(std::stod(said[1]), largest, 0.0501);
  }
}

}  // namespace
}  // namespace simbench::app
