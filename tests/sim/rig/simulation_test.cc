#include "sim/rig/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "recording/event.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/recording/test_sink.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

class Collector final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override {
    EXPECT_TRUE(frames.empty());
    EXPECT_EQ(adjustments, 0) << "the layout comes first";
    pulses_expected = layout.pulses;
  }
  void on_event(const RecordingEvent& event) override {
    std::visit(Overloaded{[this](const PulseTruth& truth) { add(truth); },
                          [this](const ClockAdjustment&) { ++adjustments; },
                          [this](const ExchangeEvent&) { ++exchanges; },
                          [this](const SyncOutcome& outcome) { outcomes.push_back(outcome); },
                          [this](const SessionDelays& reported) { delays.push_back(reported); },
                          [](const auto&) {}},
               event);
  }

  std::vector<FrameRecord> frames;
  std::vector<FrameTruth> truths;
  std::map<std::size_t, std::vector<double>> host_errors_ms;
  std::vector<SyncOutcome> outcomes;
  std::vector<SessionDelays> delays;
  int adjustments = 0;
  int exchanges = 0;
  std::int64_t pulses_expected = 0;

 private:
  void frame_came(const FrameRecord& record, const FrameTruth* truth) override {
    frames.push_back(record);
    truths.push_back(*truth);
  }
  void add(const PulseTruth& truth) {
    for (std::size_t host = 0; host < truth.host_errors.size(); ++host) {
      host_errors_ms[host].push_back(to_ms(truth.host_errors[host]));
    }
  }
};

RecordingCost record(const scenarios::Scenario& scenario, const std::string& host_sync,
                     RecordingSink& sink, std::uint64_t seed = 1) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(host_sync);
  const auto algorithm = entry->make(check_parameters(entry->info.parameters, {}));
  return make_simulation(scenario)->record(
      {.seed = seed, .pipeline = host_sync, .host_sync = algorithm.get()}, sink);
}

// Hosts that differ by 300 ms, and calls and messages that take time.
scenarios::Scenario two_unequal_hosts() {
  scenarios::Scenario s = ideal_scenario();
  s.hosts.clock.initial_offset_sigma_ms = 300;
  s.hosts.clock.set_cost_ms = 4;
  s.hosts.clock.set_effective_fraction = 0.25;
  s.hosts.send_cost_ms = 3;
  s.hosts.receive_wake_up_ms = 0.02;
  return s;
}

// The delay that a slave needs: occupancy of the send, latency, wake-up, and the part of its own
// set call after which the value counts.
constexpr double kNeededMs = 3 + 0.1 + 0.02 + 0.25 * 4;

TEST(Simulation, EachDelayOfThePaperLeavesTheErrorThatItsFormulaSays) {
  const double t_l = 3;  // literally: the spacing of the stamps
  const double t_t = 2;  // half of a set call
  for (const auto& [host_sync, t_d] : std::map<std::string, double>{{"yoon2021_neither", 0},
                                                                    {"yoon2021_network", t_l},
                                                                    {"yoon2021_time", t_t},
                                                                    {"yoon2021_both", t_l + t_t}}) {
    Collector result;
    record(two_unequal_hosts(), host_sync, result);
    ASSERT_EQ(result.outcomes.size(), 1u);
    EXPECT_TRUE(result.outcomes[0].synchronised) << result.outcomes[0].message;
    ASSERT_EQ(result.delays.size(), 1u);
    EXPECT_NEAR(to_ms(result.delays[0].t_l), t_l, 1e-4) << host_sync;
    EXPECT_NEAR(to_ms(result.delays[0].t_t), t_t, 1e-4) << host_sync;
    EXPECT_NEAR(to_ms(result.delays[0].t_d), t_d, 1e-4) << host_sync;
    EXPECT_NEAR(to_ms(result.delays[0].get), 0, 1e-4) << host_sync;
    EXPECT_NEAR(to_ms(result.delays[0].set), 4, 1e-4) << host_sync;
    ASSERT_EQ(result.host_errors_ms[1].size(), 90u);
    for (const double error_ms : result.host_errors_ms[1]) {
      EXPECT_NEAR(error_ms, t_d - kNeededMs, 1e-4) << host_sync;
    }
  }
}

TEST(Simulation, OracleHostsHaveNoErrorAndFreeRunningOnesKeepTheirs) {
  Collector oracle;
  record(two_unequal_hosts(), "oracle", oracle);
  for (const double error_ms : oracle.host_errors_ms[1]) EXPECT_EQ(error_ms, 0);
  Collector free_running;
  record(two_unequal_hosts(), "free_running", free_running);
  EXPECT_GT(std::abs(free_running.host_errors_ms[1][0]), 0.01);
  EXPECT_EQ(free_running.host_errors_ms[1].front(), free_running.host_errors_ms[1].back());
}

TEST(Simulation, ALastSetClockIsOffByItsRateTimesTheHours) {
  scenarios::Scenario s = two_unequal_hosts();
  s.hosts.clock.last_set = {.hours_ago = 5, .skew_sigma_ppm = 10, .minutes_since_baseline = 0};
  double squares = 0;
  const int seeds = 400;
  for (int seed = 1; seed <= seeds; ++seed) {
    s.timeline.frames = 1;
    Collector result;
    record(s, "ntp_last_set", result, static_cast<std::uint64_t>(seed));
    squares += result.host_errors_ms[1][0] * result.host_errors_ms[1][0];
  }
  // N(10 ppm) over 5 h: 180 ms.
  EXPECT_NEAR(std::sqrt(squares / seeds), 180, 5 * 180 / std::sqrt(2.0 * seeds)) << "seeds 1-400";
}

TEST(Simulation, PipelinesOfASeedSeeTheSameFrames) {
  const scenarios::Scenario s =
      scenarios::load_scenario("18cam_6host_45fps", {{"/timeline/frames", "30"}});
  Collector free_running;
  Collector network;
  Collector service;
  record(s, "free_running", free_running, 7);
  record(s, "yoon2021_network", network, 7);
  record(s, "w32time", service, 7);
  for (const Collector* other : {&network, &service}) {
    ASSERT_EQ(other->frames.size(), free_running.frames.size());
    for (std::size_t i = 0; i < nonempty(free_running.frames).size(); ++i) {
      const FrameRecord& frame = free_running.frames[i];
      EXPECT_EQ(other->frames[i].camera, frame.camera);
      EXPECT_EQ(other->frames[i].counter, frame.counter);
      EXPECT_EQ(other->frames[i].exposure_us, frame.exposure_us);
      EXPECT_EQ(other->truths[i].pulse, free_running.truths[i].pulse);
      // A capture starts when its synchronisation has ended: intervals compare, up to rounding.
      const auto steady_ns = [&](const Collector& run) {
        const auto first = std::find_if(run.frames.begin(), run.frames.end(),
                                        [&](const auto& f) { return f.camera == frame.camera; });
        return static_cast<double>((run.frames[i].arrival_steady - first->arrival_steady).count());
      };
      EXPECT_NEAR(steady_ns(*other), steady_ns(free_running), 5);
    }
  }
}

TEST(Simulation, EqualRequestsGiveEqualTracesAndOthersDoNot) {
  const scenarios::Scenario s =
      scenarios::load_scenario("18cam_6host_45fps", {{"/timeline/frames", "30"}});
  KeptRecording sink;
  const RecordingCost first = record(s, "yoon2021_both", sink, 3);
  const RecordingCost again = record(s, "yoon2021_both", sink, 3);
  const RecordingCost other_seed = record(s, "yoon2021_both", sink, 4);
  const RecordingCost other_pipeline = record(s, "yoon2021_time", sink, 3);
  EXPECT_EQ(first.trace_hash, again.trace_hash);
  EXPECT_EQ(first.events, again.events);
  EXPECT_NE(first.trace_hash, other_seed.trace_hash);
  EXPECT_NE(first.trace_hash, other_pipeline.trace_hash);
}

TEST(Simulation, AServiceRunsBeforeAndDuringTheCapture) {
  scenarios::Scenario s = two_unequal_hosts();
  s.hosts.clock.oscillator.skew_sigma_ppm = 10;
  Collector result;
  const RecordingCost cost = record(s, "w32time", result);
  EXPECT_GT(cost.simulated_seconds, 20 * 3600);
  EXPECT_GT(result.exchanges, 1);
  EXPECT_GT(result.adjustments, 2);
  EXPECT_EQ(result.host_errors_ms[1].size(), 90u);
}

class NeverReady final : public HostSync {
 public:
  Task<void> run_master(Host& host, std::vector<PeerId>) override {
    MessageChannel& channel = host.open_channel(1, Transport::kStream);
    const auto message = co_await channel.receive(SteadyTime::max());
    static_cast<void>(message);
  }
  Task<void> run_slave(Host&, PeerId) override { co_return; }
};

TEST(Simulation, NotesClocksThatGoNoFurther) {
  scenarios::Scenario s = ideal_scenario();
  Collector usual;
  EXPECT_TRUE(make_simulation(s)->record({.seed = 1, .pipeline = "none"}, usual).notes.empty());
  s.hosts.clock.oscillator.random_walk_ppb_per_sqrt_s = 1e9;
  s.hosts.clock.oscillator.wander_step_ms = 1000;
  s.cameras.oscillator.ramp_ppm_per_hour = -1e9;
  Collector result;
  const std::vector<std::string> notes =
      make_simulation(s)->record({.seed = 1, .pipeline = "none"}, result).notes;
  ASSERT_EQ(notes.size(), 2u);
  const auto all = [](std::int64_t count, const std::string& devices) {
    const std::string number = std::to_string(count);
    return "the clocks of " + number + " of " + number + " " + devices +
           " reached a frequency error of 5 %: their random walk or ramp goes no further";
  };
  EXPECT_EQ(notes[0], all(s.hosts.count, "hosts"));
  EXPECT_EQ(notes[1], all(s.cameras.count, "cameras"));
}

TEST(Simulation, AWorldTooLargeForTheEngineIsRefusedInOneLine) {
  const scenarios::Scenario s = ideal_scenario();
  Collector result;
  const auto source = make_limited_simulation(s, {.max_events = 100});
  try {
    source->record({.seed = 1, .pipeline = "none"}, result);
    FAIL() << "no InputError";
  } catch (const scenarios::InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("found a world that is too large: limit of 100 events reached"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST(Simulation, SaysWhatAStandstillWaitsFor) {
  const scenarios::Scenario s = ideal_scenario();
  NeverReady stuck;
  Collector result;
  try {
    make_simulation(s)->record({.seed = 1, .pipeline = "stuck", .host_sync = &stuck}, result);
    FAIL() << "no SimulationError";
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("host0: receive from host1"), std::string::npos)
        << error.what();
  }
}

class Throwing final : public HostSync {
 public:
  Task<void> run_master(Host& host, std::vector<PeerId>) override {
    co_await host.sleep_for(from_ms(1));
    throw std::runtime_error("no route to host");
  }
  Task<void> run_slave(Host& host, PeerId) override { co_await host.sleep_for(from_ms(1000)); }
};

TEST(Simulation, PassesOnWhatAnAlgorithmThrows) {
  const scenarios::Scenario s = ideal_scenario();
  Throwing algorithm;
  Collector result;
  const auto source = make_simulation(s);
  EXPECT_THROW(source->record({.seed = 1, .pipeline = "throwing", .host_sync = &algorithm}, result),
               std::runtime_error);
}

TEST(Simulation, WorksWithoutHostSync) {
  const scenarios::Scenario s = ideal_scenario();
  Collector result;
  make_simulation(s)->record({.seed = 1, .pipeline = "none"}, result);
  EXPECT_EQ(result.frames.size(), 270u);
  EXPECT_EQ(result.pulses_expected, 90);
}

}  // namespace
}  // namespace simbench::sim
