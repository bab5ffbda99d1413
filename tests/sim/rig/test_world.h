// Whole simulated runs for tests: a recording kept as lists, and a service made of functions.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "recording/recording.h"
#include "sim/rig/simulation.h"
#include "tests/recording/test_sink.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {

class KeptLists final : public TestSink {
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
  void on_event(const RecordingEvent& event) override {
    if (const auto* pulse = std::get_if<PulseTruth>(&event)) {
      pulses.push_back({pulse->pulse, pulse->at});
    } else if (const auto* poll = std::get_if<DevicePoll>(&event)) {
      polls.push_back(*poll);
    } else if (const auto* sighting = std::get_if<LedSighting>(&event)) {
      sightings.push_back({*sighting, frames.size() - 1});
    }
  }

  std::vector<Frame> frames;
  std::vector<Pulse> pulses;
  std::vector<DevicePoll> polls;
  std::vector<Sighting> sightings;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    frames.push_back({frame, *truth});
  }
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
