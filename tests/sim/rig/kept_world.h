// An observer that keeps what it is notified of.
#pragma once

#include <vector>

#include "recording/world_observer.h"

namespace simbench::sim {

class KeptWorld final : public WorldObserver {
 public:
  struct Clocks {
    TrueTime at;
    std::vector<Nanoseconds> errors;
  };
  explicit KeptWorld(Nanoseconds interval) : interval_(interval) {}

  Nanoseconds clock_interval() const override { return interval_; }
  void on_world(TrueTime start) override { world_starts.push_back(start); }
  void on_capture_start(TrueTime at) override { capture_starts.push_back(at); }
  void on_pulse(const ObservedPulse& pulse) override { pulses.push_back(pulse); }
  void on_frame(const ObservedFrame& frame) override { frames.push_back(frame); }
  void on_message(const ObservedMessage& message) override { messages.push_back(message); }
  void on_clocks(TrueTime at, std::span<const Nanoseconds> errors) override {
    clocks.push_back({at, {errors.begin(), errors.end()}});
  }

  std::vector<TrueTime> world_starts;
  std::vector<TrueTime> capture_starts;
  std::vector<ObservedPulse> pulses;
  std::vector<ObservedFrame> frames;
  std::vector<ObservedMessage> messages;
  std::vector<Clocks> clocks;

 private:
  Nanoseconds interval_;
};

}  // namespace simbench::sim
