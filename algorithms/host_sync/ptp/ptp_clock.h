// The clocks that PTP steers, and their stamps.
//
// Every stamp is a count of nanoseconds of the clock in use: the system clock with software stamps,
// the network card's clock with hardware stamps.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_CLOCK_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_CLOCK_H_

#include <cstdint>
#include <memory>
#include <optional>

#include "algorithms/host_sync/ptp/ptp.h"
#include "algorithms/host_sync/ptp/ptp_servo.h"
#include "algorithms/ports/host.h"

namespace simbench {

enum class ClockKind : std::uint8_t { kSystem, kHardware };

// Adds `offset` to the system clock. A set call is late by a part of its duration, so what it did
// is measured against the steady clock and the rest is set again; at most kStepCalls calls.
Task<void> step_system_clock(Host& host, Nanoseconds offset);

// What a servo answered, done to the clock: `offset` is what the servo was fed.
Task<void> apply_answer(Host& host, ClockKind kind, ServoAnswer answer, Nanoseconds offset);

// When the message left that send() has just returned from; nothing if the card did not tell.
Task<std::optional<std::int64_t>> departure_stamp(Host& host, MessageChannel& channel, MessageId id,
                                                  ClockKind kind);
std::optional<std::int64_t> arrival_stamp(const ReceivedMessage& message, ClockKind kind);

std::unique_ptr<Servo> make_port_servo(const PtpSettings& settings);

// phc2sys: one of a host's two clocks follows the other. The host must have a hardware clock.
class ClockCoupling {
 public:
  static constexpr int kCrossStamps = 5;
  static constexpr Nanoseconds kInterval{1'000'000'000};

  ClockCoupling(Host& host, ClockKind follower, const PtpSettings& settings);
  // One measurement and correction.
  Task<void> update();
  bool is_locked() const { return is_locked_; }

 private:
  Host& host_;
  ClockKind follower_;
  PiServo servo_;
  bool is_locked_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_CLOCK_H_
