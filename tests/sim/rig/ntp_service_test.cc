// The NTP family in the whole simulated rig: services that run before and during a capture.
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
#include "recording/recording.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/recording/test_sink.h"

namespace simbench::sim {
namespace {

class PulseErrors final : public TestSink {
 public:
  void on_event(const RecordingEvent& event) override {
    std::visit(Overloaded{[this](const PulseTruth& pulse) { add(pulse); },
                          [this](const ClockAdjustment& adjustment) {
                            if (adjustment.after != adjustment.before) ++steps;
                            ++adjustments;
                          },
                          [this](const ExchangeEvent&) { ++exchanges; },
                          [this](const SyncOutcome& outcome) {
                            EXPECT_TRUE(outcome.synchronised) << outcome.message;
                            ++outcomes[outcome.slave];
                          },
                          [](const auto&) {}},
               event);
  }

  double sum_us = 0;
  int count = 0;
  int steps = 0;
  int adjustments = 0;
  int exchanges = 0;
  std::map<PeerId, int> outcomes;

 private:
  void add(const PulseTruth& pulse) {
    for (std::size_t host = 1; host < pulse.host_errors.size(); ++host) {
      sum_us += std::abs(to_ms(pulse.host_errors[host])) * 1e3;
      ++count;
    }
  }
};

PulseErrors record_lan(const std::string& name, std::uint64_t seed) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_45fps_lan", {{"/timeline/frames", "10"}});
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(name);
  const auto algorithm = entry->make(check_parameters(entry->info.parameters, {}));
  PulseErrors errors;
  make_simulation(scenario)->record({.seed = seed, .pipeline = name, .host_sync = algorithm.get()},
                                    errors);
  return errors;
}

struct Plausible {
  std::string name;
  double low_us;
  double high_us;
};

// Mean |error| of the slaves' clocks, median of three seeds. The lower bounds are what no algorithm
// on these stamps can pass (5 us of asymmetry), the upper ones some times what was measured.
TEST(NtpFamily, HostErrorsInTheLanAreWhatThePhysicsAllows) {
  for (const auto& [name, low_us, high_us] :
       std::vector<Plausible>{{"chrony", 4, 300},
                              {"ntp", 20, 5000},
                              {"ntp_broadcast_volley", 50, 5000},
                              {"ntp_lan", 4, 200},
                              {"ntp_daemon_loop", 20, 5000},
                              {"ntp_broadcast_fixed", 1500, 2500},  // 2 ms added, 0.17 ms real
                              {"w32time_domain", 500, 50000}}) {
    std::vector<double> means_us;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const PulseErrors errors = record_lan(name, seed);
      ASSERT_GT(errors.count, 0);
      means_us.push_back(errors.sum_us / errors.count);
      EXPECT_EQ(errors.outcomes.size(), 5U) << name << ", seed " << seed;
      for (const auto& [slave, times] : errors.outcomes) EXPECT_EQ(times, 1) << name << slave;
      EXPECT_GT(errors.adjustments, errors.steps + 10) << name << ": slews are in the log";
      EXPECT_GT(errors.exchanges, 20) << name;
    }
    std::sort(means_us.begin(), means_us.end());
    RecordProperty(name + "_median_us", std::to_string(means_us[1]));
    EXPECT_GT(means_us[1], low_us) << name;
    EXPECT_LT(means_us[1], high_us) << name;
  }
}

TEST(NtpFamily, EqualSeedsGiveEqualRuns) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_45fps_lan", {{"/timeline/frames", "10"}});
  for (const std::string name : {"chrony", "ntp_broadcast_volley"}) {
    const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(name);
    const auto algorithm =
        entry->make(check_parameters(entry->info.parameters, {{"service_hours", 1.0}}));
    const RecordingRequest request{.seed = 3, .pipeline = name, .host_sync = algorithm.get()};
    PulseErrors first;
    PulseErrors again;
    const std::uint64_t hash = make_simulation(scenario)->record(request, first).trace_hash;
    EXPECT_EQ(make_simulation(scenario)->record(request, again).trace_hash, hash) << name;
    EXPECT_EQ(first.sum_us, again.sum_us) << name;
  }
}

}  // namespace
}  // namespace simbench::sim
