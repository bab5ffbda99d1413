// The clocks that PTP's servos steer: the system clock, or the network card's and then, through
// phc2sys, the system clock.
//
//   ClockCoupling coupling(host, ClockKind::kSystem, {});
//   while (true) {
//     co_await coupling.update();
//     co_await host.sleep_for(ClockCoupling::kInterval);
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "algorithms/host_sync/ptp/ptp_servo.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"

namespace simbench {

enum class ClockKind : std::uint8_t { kSystem, kHardware };

// The clock that stamps, which is the one to steer.
inline ClockKind clock_of(StampSource stamps) {
  return stamps == StampSource::kCard ? ClockKind::kHardware : ClockKind::kSystem;
}

// The settings, with a largest frequency that the clock takes.
ServoSettings limited_by(Host& host, ClockKind clock, ServoSettings settings);

// Does to the clock what the servo answered, which had been fed `offset`. A set call of the system
// clock takes effect late by a part of its duration, so a step is measured against the steady clock
// and its rest set again.
Task<void> apply_answer(Host& host, ClockKind clock, ServoAnswer answer, Nanoseconds offset);
// Its two parts.
Task<void> set_frequency(Host& host, ClockKind clock, double ppb);
Task<void> step_clock(Host& host, ClockKind clock, Nanoseconds offset);

// phc2sys: one of a host's two clocks follows the other. Each update takes the narrowest of several
// cross stamps (cross_stamps.h) and feeds it to a PI servo with the constants of hardware stamps.
// The host must have a hardware clock, and outlive this.
class ClockCoupling {
 public:
  static constexpr Nanoseconds kInterval{1'000'000'000};

  // `settings` without its interval, which is kInterval.
  ClockCoupling(Host& host, ClockKind follower, ServoSettings settings);
  // Measures and corrects once.
  Task<void> update();
  bool is_locked() const { return is_locked_; }

 private:
  Host& host_;
  ClockKind follower_;
  PiServo servo_;
  bool is_locked_ = false;
};

// Updates for ever, every kInterval; *is_locked says whether the clocks agree.
Task<void> keep_coupled(Host& host, ClockKind follower, ServoSettings settings,
                        std::shared_ptr<bool> is_locked);

// The master's side of a protocol whose clocks these are: serve(slave, is_ready) towards each
// slave, at the same time. *is_ready once the clock that stamps agrees with the system clock, which
// the network card's follows here. A host that lacks a card for its stamps serves nobody: its
// slaves will report that nothing came.
using ServeSlave = std::function<Task<void>(PeerId slave, std::shared_ptr<const bool> is_ready)>;
Task<void> serve_slaves(Host& host, std::vector<PeerId> slaves, StampSource stamps,
                        ServoSettings settings, ServeSlave serve);

// Serves slaves from a host that follows another: its slave's side steers the clock that stamps and
// says when it is ready.
Task<void> serve_slaves_of_relay(std::vector<PeerId> slaves, std::shared_ptr<const bool> is_ready,
                                 ServeSlave serve);

}  // namespace simbench
