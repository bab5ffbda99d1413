// Whole simulated runs for tests: a recording kept as lists, and a service made of functions.
#ifndef SIMBENCH_TESTS_SIM_RIG_TEST_WORLD_H_
#define SIMBENCH_TESTS_SIM_RIG_TEST_WORLD_H_

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "recording/recording.h"
#include "sim/rig/simulation.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {

class KeptLists final : public RecordingSink {
 public:
  struct Frame {
    FrameRecord record;
    FrameTruth truth;
  };
  struct Pulse {
    std::int64_t pulse;
    TrueTime at;
  };
  struct Sighting {
    LedSighting led;
    std::size_t frame;  // the newest frame then
  };
  void on_start(const RigLayout&) override {}
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    frames.push_back({frame, *truth});
  }
  void on_pulse(const PulseTruth& truth) override { pulses.push_back({truth.pulse, truth.at}); }
  void on_adjustment(const ClockAdjustment&) override {}
  void on_poll(const DevicePoll& poll) override { polls.push_back(poll); }
  void on_exchange(std::uint32_t, const Exchange&) override {}
  void on_outcome(const SyncOutcome&) override {}
  void on_led_sighting(const LedSighting& sighting) override {
    sightings.push_back({sighting, frames.size() - 1});
  }

  std::vector<Frame> frames;
  std::vector<Pulse> pulses;
  std::vector<DevicePoll> polls;
  std::vector<Sighting> sightings;
};

// Runs `program` on every host from `warm_up` before true zero to the end of the capture.
class Service final : public HostSync {
 public:
  using Program = std::function<Task<void>(Host& host)>;
  explicit Service(Program program, Nanoseconds warm_up = from_ms(0))
      : program_(std::move(program)), warm_up_(warm_up) {}
  std::optional<Nanoseconds> warm_up() const override { return warm_up_; }
  Task<void> run_master(Host& host, std::vector<PeerId>) override { return program_(host); }
  Task<void> run_slave(Host& host, PeerId) override { return program_(host); }

 private:
  Program program_;
  Nanoseconds warm_up_;
};

inline RecordingCost run_world(const scenarios::Scenario& scenario, HostSync* host_sync,
                               KeptLists& kept, std::uint64_t seed = 1) {
  return make_simulation(scenario)->record(
      {.seed = seed, .pipeline = "test", .host_sync = host_sync}, kept);
}

}  // namespace simbench::sim

#endif  // SIMBENCH_TESTS_SIM_RIG_TEST_WORLD_H_
