// Huygens in the simulated network: what its loops gain where each link has an asymmetry of its
// own, and that they gain nothing where each port has. The expectations are those of
// tests/algorithms/host_sync/huygens/network_effect_test.cc.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/recording/test_sink.h"

namespace simbench::sim {
namespace {

// The mean error of each slave.
class SlaveErrors : public TestSink {
 public:
  int failures = 0;

  void on_event(const RecordingEvent& event) override {
    if (const auto* pulse = std::get_if<PulseTruth>(&event)) {
      sums_us_.resize(pulse->host_errors.size());
      for (std::size_t host = 0; host < sums_us_.size(); ++host) {
        sums_us_[host] += to_ms(pulse->host_errors[host]) * 1e3;
      }
      ++pulses_;
    } else if (const auto* outcome = std::get_if<SyncOutcome>(&event)) {
      if (!outcome->synchronised) ++failures;
    }
  }

  std::vector<double> means_us() const {
    std::vector<double> means;
    means.reserve(sums_us_.size());
    for (const double sum : sums_us_) means.push_back(sum / pulses_);
    return means;
  }

 private:
  std::vector<double> sums_us_;
  double pulses_ = 0;
};

std::vector<double> means_us(const std::string& name, const scenarios::Scenario& scenario,
                             std::uint64_t seed) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(name);
  const auto host_sync = entry->make(check_parameters(entry->info.parameters, {}));
  SlaveErrors errors;
  make_simulation(scenario)->record({.seed = seed, .pipeline = name, .host_sync = host_sync.get()},
                                    errors);
  EXPECT_EQ(errors.failures, 0) << name << ", seed " << seed;
  return errors.means_us();
}

scenarios::Scenario lan_with(const std::string& asymmetry) {
  return scenarios::load_scenario("18cam_6host_45fps_lan",
                                  {{"/timeline/frames", "60"},
                                   {"/hosts/nic/hardware_stamps", "true"},
                                   {"/network/latency_fixed_ms", "0.2"},
                                   {"/network/asymmetry_sigma_ms", "0"},
                                   {"/network/port_asymmetry_sigma_ms", "0"},
                                   {"/network/" + asymmetry, "0.02"}});
}

constexpr int kHuygensSeeds = 24;

TEST(HuygensClosedLoopTest, AsymmetryOfLinksFallsByTheRootOfHalfTheHosts) {
  // Half of N(0, 20 us), and sqrt(2 / 6) of that.
  const scenarios::Scenario scenario = lan_with("asymmetry_sigma_ms");
  double squares = 0;
  double count = 0;
  for (std::uint64_t seed = 1; seed <= kHuygensSeeds; ++seed) {
    const std::vector<double> errors = means_us("huygens_hardware", scenario, seed);
    for (std::size_t host = 1; host < errors.size(); ++host) {
      squares += errors[host] * errors[host];
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 10 * std::sqrt(2.0 / 6), 1.2);
}

TEST(HuygensClosedLoopTest, AsymmetryOfPortsStaysAsItIsForOneLink) {
  // Both means have some 0.3 us of noise of their own, against asymmetries of 20 us.
  const scenarios::Scenario scenario = lan_with("port_asymmetry_sigma_ms");
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const std::vector<double> direct = means_us("ptp_e2e_hardware", scenario, seed);
    const std::vector<double> corrected = means_us("huygens_hardware", scenario, seed);
    ASSERT_EQ(direct.size(), corrected.size());
    double largest = 0;
    for (std::size_t host = 1; host < direct.size(); ++host) {
      EXPECT_NEAR(corrected[host], direct[host], 1) << "seed " << seed << ", host " << host;
      largest = std::max(largest, std::abs(direct[host]));
    }
    EXPECT_GT(largest, 5) << "seed " << seed;
  }
}

}  // namespace
}  // namespace simbench::sim
