// What an answer must and must not say in worlds whose truth is known, because each was made with
// one thing wrong, or with nothing that differs. Every world runs with three first seeds.
//
// Where two pipelines differ by chance alone, a test at 5 % errs in one of twenty worlds by design:
// there the number of false verdicts is held to what chance makes of so many.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/answer.h"
#include "evaluation/answer/answer.h"
#include "evaluation/run/evaluate.h"
#include "reports/results/results_answer.h"
#include "reports/text/answer_text.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::app {
namespace {

using evaluation::Results;
using scenarios::Override;
using testing::AnyOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr std::uint64_t kFirstSeeds[] = {1, 1001, 424242};
constexpr std::uint64_t kWorldSeeds = 12;

struct Said {
  Results results;
  reports::ResultsAnswer answer{};
  std::string text{};  // all of it, with labels
};

struct AnsweredWorld {
  std::string name;
  std::string scenario;
  std::vector<Override> sets;
  std::function<void(const Said&)> check;
  bool levers = false;
  std::uint64_t seeds = kWorldSeeds;
};

std::string pipeline(const char* name, const char* host_sync, const char* device_time,
                     const char* gathering = "yoon2021") {
  return fmt::format(
      R"({{"name": "{}", "host_sync": "{}", "device_time": "{}", "gathering": "{}"}})", name,
      host_sync, device_time, gathering);
}

Override pipelines(const std::vector<std::string>& all) {
  return {"/pipelines", fmt::format("[{}]", fmt::join(all, ", "))};
}

// A rig of so many hosts with two cameras each, for a second or two.
std::vector<Override> rig(int hosts, std::vector<Override> more) {
  std::vector<Override> sets = {{"/hosts/count", fmt::format("{}", hosts)},
                                {"/cameras/count", fmt::format("{}", 2 * hosts)},
                                {"/cameras/cameras_per_host", "2"},
                                {"/timeline/frames", "50"},
                                {"/timeline/warm_up_ms", "1000"}};
  sets.insert(sets.end(), more.begin(), more.end());
  return sets;
}

std::string text_of(const reports::AnswerText& answer) {
  std::string text = answer.lead;
  for (const reports::AnswerPoint& point : answer.points) {
    text += "\n" + point.label + ": " + point.text;
  }
  return text;
}

Said said_in(const AnsweredWorld& world, std::uint64_t first_seed) {
  const scenarios::Scenario scenario = scenarios::load_scenario(world.scenario, world.sets);
  Said said{.results = evaluation::evaluate(
                scenario, [&] { return sim::make_simulation(scenario); },
                {.first_seed = first_seed, .seeds = world.seeds, .jobs = 2, .share_captures = true},
                nullptr)};
  said.answer = run_answer(said.results, scenario, {.levers = world.levers, .jobs = 2}, nullptr);
  said.text = text_of(said.answer.text);
  return said;
}

std::string best_in(const Said& said) {
  return said.answer.data.best == nullptr ? "" : said.answer.data.best->pipeline;
}

bool is_failed(const Said& said, const std::string& name) {
  return std::ranges::any_of(said.answer.data.failed,
                             [&](const auto& each) { return each.row->pipeline == name; });
}

// Names of the levers, in their order.
std::string levers(const Said& said) {
  std::string names;
  if (!said.answer.levers) return "not searched";
  for (const evaluation::Lever& lever : said.answer.levers->effective) names += lever.what + "; ";
  return names;
}

constexpr const char* kLan = "18cam_6host_45fps_lan";
constexpr const char* kFitted = "18cam_6host_45fps";

// Nothing differs: the same method under three names, so the values are equal to the bit.
void add_equal_worlds(std::vector<AnsweredWorld>& worlds) {
  const auto check = [](const Said& said) {
    EXPECT_FALSE(said.answer.data.next.has_value());
    EXPECT_THAT(said.text, Not(HasSubstr("The next")));
    EXPECT_THAT(said.text, Not(HasSubstr("times as much")));
  };
  for (const int hosts : {1, 2, 3, 4}) {
    for (const char* host_sync : {"two_way_hull", "yoon2021_both", "chrony_lan"}) {
      worlds.push_back({fmt::format("equal, {} hosts, {}", hosts, host_sync), kLan,
                        rig(hosts, {pipelines({pipeline("a", host_sync, "hull_300"),
                                               pipeline("b", host_sync, "hull_300"),
                                               pipeline("c", host_sync, "hull_300")})}),
                        check});
    }
  }
}

// Exposures that do not fit: half of the pulses are lost, and shorter exposures find them.
void add_long_exposures(std::vector<AnsweredWorld>& worlds) {
  const auto check = [](const Said& said) {
    EXPECT_THAT(said.answer.text.lead, HasSubstr("pulses due are lost"));
    EXPECT_THAT(said.answer.text.lead, HasSubstr("exposures of up to"));
    EXPECT_THAT(said.text, Not(HasSubstr("no pulse is missing")));
    EXPECT_THAT(levers(said), HasSubstr("half of the light"));
  };
  for (const int hosts : {1, 2, 3}) {
    worlds.push_back({fmt::format("long exposures, {} hosts", hosts), kLan,
                      rig(hosts, {{"/cameras/exposure_ms", "24"},
                                  {"/cameras/exposure_camera_periods", "0"},
                                  pipelines({pipeline("a", "two_way_hull", "hull_300")})}),
                      check, true});
  }
  worlds.push_back({"pi-hq-half-rate",
                    "3cam_1host_30fps",
                    {{"/cameras/exposure_ms", "40"}, {"/timeline/frames", "60"}},
                    [](const Said& said) {
                      EXPECT_THAT(said.answer.text.lead, HasSubstr("pulses due are lost"));
                      EXPECT_THAT(said.text, Not(HasSubstr("no pulse is missing")));
                    }});
}

// Frames that never come, with their reason.
void add_losses(std::vector<AnsweredWorld>& worlds) {
  const auto lost = [](const char* reason) {
    return [reason](const Said& said) {
      EXPECT_THAT(said.answer.text.lead, HasSubstr("pulses due are lost"));
      EXPECT_THAT(said.answer.text.lead, HasSubstr(reason));
      EXPECT_THAT(said.text, Not(HasSubstr("no pulse is missing")));
    };
  };
  const std::vector<std::pair<Override, const char*>> causes = {
      {{"/cameras/drop_probability", "0.05"}, "drop_probability"},
      {{"/cameras/drop_probability", "0.3"}, "drop_probability"},
      {{"/trigger/missed_pulse_probability", "0.1"}, "missed_pulse_probability"},
      {{"/usb/bandwidth_mb_per_s", "60"}, "bandwidth"}};
  for (const auto& [cause, reason] : causes) {
    for (const int hosts : {1, 2}) {
      worlds.push_back({fmt::format("{}={}, {} hosts", cause.pointer, cause.value, hosts), kLan,
                        rig(hosts, {cause, pipelines({pipeline("a", "two_way_hull", "hull_300")})}),
                        lost(reason)});
    }
  }
}

// Clocks that nobody synchronises fail, and are neither best nor next.
void add_failures(std::vector<AnsweredWorld>& worlds) {
  for (const int hosts : {2, 3, 4}) {
    worlds.push_back({fmt::format("unsynchronised, {} hosts", hosts), kLan,
                      rig(hosts, {{"/hosts/clock/initial_offset_sigma_ms", "500"},
                                  pipelines({pipeline("lost", "free_running", "hull_300"),
                                             pipeline("good", "two_way_hull", "hull_300")})}),
                      [](const Said& said) {
                        EXPECT_EQ(best_in(said), "good");
                        EXPECT_TRUE(is_failed(said, "lost"));
                        EXPECT_FALSE(said.answer.data.next.has_value());
                        EXPECT_THAT(said.text,
                                    HasSubstr("lost failed: no gathered set is of one pulse"));
                      }});
  }
  worlds.push_back({"half-interval-window",
                    "9cam_3host_30fps_azure_kinect",
                    {{"/hosts/count", "1"},
                     {"/trigger/rate_hz", "5"},
                     {"/trigger/daisy_chain_delay_us", "110000"},
                     {"/cameras/count", "2"},
                     {"/cameras/cameras_per_host", "2"},
                     {"/cameras/streams",
                      R"([{"kind": "depth", "width": 640, "height": 576, "bytes_per_pixel": 2,
                           "mode_rate_hz": 5, "pipeline_latency_ms": 8,
                           "latency_mode_periods": 0.1, "shutter": "global", "readout_ms": 0}])"},
                     {"/timeline/frames", "60"},
                     pipelines({pipeline("window", "free_running", "regression_300"),
                                pipeline("pairs", "free_running", "regression_300", "k4a")})},
                    [](const Said& said) {
                      EXPECT_EQ(best_in(said), "pairs");
                      EXPECT_TRUE(is_failed(said, "window"));
                      EXPECT_THAT(said.text, HasSubstr("gathering's interval"));
                    }});
}

// The better of two by a cause that is plain: unequal paths, late stamps, unequal exposures.
void add_differences(std::vector<AnsweredWorld>& worlds) {
  for (const int hosts : {2, 3, 4}) {
    worlds.push_back({fmt::format("hull against arrivals, {} hosts", hosts), kLan,
                      rig(hosts, {{"/usb/delivery_jitter_transfers", "1"},
                                  pipelines({pipeline("arrivals", "two_way_hull", "raw_arrival"),
                                             pipeline("hull", "two_way_hull", "hull_300")})}),
                      [](const Said& said) {
                        EXPECT_EQ(best_in(said), "hull");
                        ASSERT_TRUE(said.answer.data.next.has_value());
                        EXPECT_EQ(said.answer.data.next->row->pipeline, "arrivals");
                        EXPECT_GT(said.answer.data.next->to_best.ratio.value, 1);
                      }});
    worlds.push_back({fmt::format("unequal exposures, {} hosts", hosts), kLan,
                      rig(hosts, {{"/cameras/exposure_camera_periods", "0.3"},
                                  pipelines({pipeline("a", "two_way_hull", "hull_300")})}),
                      [](const Said& said) {
                        EXPECT_THAT(levers(said), AnyOf(HasSubstr("equal exposures"),
                                                        HasSubstr("exposure_corrected")));
                      },
                      true});
    worlds.push_back({fmt::format("a poor host_sync, {} hosts", hosts), kLan,
                      rig(hosts, {{"/hosts/clock/initial_offset_sigma_ms", "3"},
                                  pipelines({pipeline("a", "free_running", "hull_300")})}),
                      [](const Said& said) { EXPECT_THAT(levers(said), HasSubstr("host_sync")); },
                      true});
    worlds.push_back({fmt::format("whole milliseconds, {} hosts", hosts), kLan,
                      rig(hosts, {{"/hosts/clock/arrival_quantum_ms", "5"},
                                  {"/usb/delivery_jitter_transfers", "0"},
                                  pipelines({pipeline("a", "two_way_hull", "raw_arrival")})}),
                      [](const Said& said) {
                        EXPECT_THAT(levers(said), Not(HasSubstr("not searched")));
                        EXPECT_FALSE(said.answer.levers->effective.empty());
                      },
                      true});
  }
}

// The limit, few seeds, and what a table hides.
void add_words(std::vector<AnsweredWorld>& worlds) {
  for (const int hosts : {2, 3, 4}) {
    worlds.push_back({fmt::format("few seeds, {} hosts", hosts), kLan,
                      rig(hosts, {{"/usb/delivery_jitter_transfers", "1"},
                                  pipelines({pipeline("a", "two_way_hull", "hull_300"),
                                             pipeline("b", "two_way_hull", "raw_arrival")})}),
                      [](const Said& said) {
                        EXPECT_GT(said.answer.data.seeds_needed, 3u);
                        EXPECT_THAT(said.text, HasSubstr("too few seeds for a verdict"));
                        EXPECT_THAT(said.text, Not(HasSubstr("cannot tell from it")));
                        EXPECT_THAT(said.text, HasSubstr("in all 3 it has less than b"));
                      },
                      false, 3});
    worlds.push_back({fmt::format("limit, {} hosts", hosts), kLan,
                      rig(hosts, {pipelines({pipeline("a", "yoon2021_both", "hull_300"),
                                             pipeline("truth", "oracle", "hull_300")})}),
                      [](const Said& said) {
                        EXPECT_EQ(best_in(said), "a");
                        ASSERT_TRUE(said.answer.data.limit.has_value());
                        EXPECT_EQ(said.answer.data.limit->row->pipeline, "truth");
                        EXPECT_THAT(said.text, Not(ContainsRegex("it has 0\\.[0-9]+ times")));
                      }});
  }
}

// Steering aligns exposures that run free, and a chain of cameras has offsets that are really
// there.
void add_exposure_worlds(std::vector<AnsweredWorld>& worlds) {
  for (const char* scenario : {"8cam_raspberry_30fps", "6cam_gige_ptp_60fps"}) {
    worlds.push_back({std::string("steered, ") + scenario,
                      scenario,
                      {{"/timeline/frames", "100"}, {"/timeline/warm_up_ms", "10000"}},
                      [](const Said& said) {
                        EXPECT_NE(best_in(said), "free_run");
                        EXPECT_EQ(said.answer.data.ranked_by,
                                  evaluation::RankedBy::kExposureSpread);
                        EXPECT_THAT(said.text, Not(HasSubstr("oracle is the best")));
                      },
                      false,
                      8});
  }
  for (const int cameras : {3, 6, 9}) {
    worlds.push_back({fmt::format("a chain of {} cameras", cameras),
                      "9cam_3host_30fps_azure_kinect",
                      {{"/cameras/count", fmt::format("{}", cameras)},
                       {"/timeline/frames", "60"},
                       {"/trigger/daisy_chain_delay_us", "2000"},
                       pipelines({pipeline("a", "two_way_hull", "hull_300"),
                                  pipeline("truth", "oracle", "hull_300")})},
                      [](const Said& said) {
                        EXPECT_EQ(best_in(said), "a");
                        EXPECT_THAT(said.text, Not(ContainsRegex("it has 0\\.[0-9]+ times")));
                        EXPECT_GT(said.answer.data.best->amd_ms.median, 1) << "2 ms a camera";
                      }});
  }
}

// Nothing differs, and what all cameras share is said.
void add_shared_bias(std::vector<AnsweredWorld>& worlds) {
  for (const char* device_time : {"raw_arrival", "regression_30", "hull_300", "minimum_1s"}) {
    for (const int hosts : {1, 2}) {
      worlds.push_back({fmt::format("equal, {} hosts, {}", hosts, device_time), kLan,
                        rig(hosts, {pipelines({pipeline("a", "two_way_hull", device_time),
                                               pipeline("b", "two_way_hull", device_time)})}),
                        [](const Said& said) {
                          EXPECT_FALSE(said.answer.data.next.has_value());
                          EXPECT_THAT(said.text, HasSubstr("AMD hides that all cameras are"));
                        }});
    }
  }
}

std::vector<AnsweredWorld> all_worlds() {
  std::vector<AnsweredWorld> worlds;
  add_equal_worlds(worlds);
  add_long_exposures(worlds);
  add_losses(worlds);
  add_failures(worlds);
  add_differences(worlds);
  add_words(worlds);
  add_exposure_worlds(worlds);
  add_shared_bias(worlds);
  return worlds;
}

TEST(AnswerWorlds, AnswersSayWhatIsTrueInEach) {
  for (const AnsweredWorld& world : all_worlds()) {
    for (const std::uint64_t first_seed : kFirstSeeds) {
      SCOPED_TRACE(fmt::format("{}, from seed {}", world.name, first_seed));
      const Said said = said_in(world, first_seed);
      SCOPED_TRACE(said.text);
      world.check(said);
    }
  }
}

// Three pipelines of one method, each with a load of its own: they differ by chance alone.
TEST(AnswerWorlds, ChanceIsCrownedAsSeldomAsTheLevelSays) {
  int worlds = 0;
  int crowned = 0;
  for (const int hosts : {2, 3, 4}) {
    for (const char* rate_hz : {"15", "45"}) {
      for (const char* host_sync : {"yoon2021_both", "yoon2021_network"}) {
        for (const std::uint64_t first_seed : kFirstSeeds) {
          const AnsweredWorld world{
              "chance", kFitted,
              rig(hosts, {{"/trigger/rate_hz", rate_hz},
                          pipelines({pipeline("a", host_sync, "regression_30"),
                                     pipeline("b", host_sync, "regression_30"),
                                     pipeline("c", host_sync, "regression_30")})}),
              nullptr};
          const Said said = said_in(world, first_seed);
          ++worlds;
          crowned += said.answer.data.next ? 1 : 0;
        }
      }
    }
  }
  // More than 7 of 36 at 5 % come once in 2000 such tests. The best of three is chosen by the same
  // seeds, which makes them somewhat more.
  EXPECT_LE(crowned, 7) << "of " << worlds;
}

TEST(AnswerWorlds, AreAtLeastSixty) {
  EXPECT_GE(all_worlds().size() + 12, 60u) << "with the twelve that differ by chance alone";
}

}  // namespace
}  // namespace simbench::app
