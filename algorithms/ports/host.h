// The host as a protocol's coroutines use it: its clocks, its CPU, its network.
//
// Algorithms 1 and 2, NTP and the like are written once, as coroutines over these interfaces. The
// simulator implements them on virtual time, the hardware backend with sockets and the operating
// system's clocks; an algorithm cannot find out which.
//
// Contract
//  - Calls that take time on a real host are awaitable, and take time in the simulator too, as the
//    paper measures that time. A host has one CPU; the cost of calls and sends queues on it.
//  - Deadlines and intervals are steady time. Only sleep_until(HostTime) follows the system clock,
//    and is re-armed when that is set or slewed.
//  - Objects returned by reference live as long as the Host; the Host outlives every coroutine.
//  - Coroutines take parameters by value (or references that outlive the run), never capture in a
//    lambda, never co_await inside catch, and await once per statement.
//
// Source: docs/design.md section 4.
//
//   Task<void> greet(Host& host) {
//     MessageChannel& channel = host.open_channel(0, Transport::kStream);
//     co_await channel.send(Bytes(1));
//     auto reply = co_await channel.receive(host.steady_clock().now() + from_ms(100));
//     if (reply) co_await host.clock().set(reply->received + from_ms(2));
//   }
#pragma once

#include <boost/asio/awaitable.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"

namespace simbench {

template <class T>
using Task = boost::asio::awaitable<T>;
using Bytes = std::vector<std::byte>;

// The host's system clock, through the operating system's calls.
class HostClock {
 public:
  virtual ~HostClock() = default;
  // The reading, in the granularity of the call.
  virtual Task<HostTime> now() = 0;
  // Steps the clock. The value counts from some instant during the call.
  virtual Task<void> set(HostTime value) = 0;
  // Rate correction against the oscillator, replacing the previous one.
  virtual Task<void> adjust_frequency(double ppb) = 0;
  // The largest that adjust_frequency() takes, either way. Linux: 500 ppm by the frequency and 10 %
  // by the tick (adjtimex(2); linuxptp's clockadj_max_freq(), chronyd).
  virtual double max_frequency_ppb() const { return 100e6; }
  // Adds `offset` gradually, at no more than `max_rate_ppb`, replacing an unfinished slew; an
  // offset of 0 only ends that.
  virtual Task<void> slew(Nanoseconds offset, double max_rate_ppb) = 0;
};

// The host's oscillator; monotonic, untouched by HostClock. Reading it costs nothing measurable.
class SteadyClock {
 public:
  virtual ~SteadyClock() = default;
  virtual SteadyTime now() const = 0;
};

enum class Transport : std::uint8_t {
  kStream,    // in order, complete, with Nagle and delayed ACK where the host has them
  kDatagram,  // may be lost, duplicated, reordered
  // Datagrams of the stage capture_alignment: a channel of its own between the same hosts.
  kAlignment,
};

using MessageId = std::uint64_t;

struct ReceivedMessage {
  Bytes bytes;
  HostTime received{};  // receive stamp, from the point of the stack that stamps
  SteadyTime received_steady{};
  // When the message's end passed the network card, on the card's clock; if the card stamps.
  std::optional<HardwareTime> received_hardware{};
};

// A server waits for ever, in steps of this; a stamp that is not there after this long never comes.
inline constexpr Nanoseconds kIdle = std::chrono::hours(1);
inline constexpr Nanoseconds kStampTimeout = std::chrono::milliseconds(10);

// A two-way channel to one peer. At most one receive may be pending on a channel.
class MessageChannel {
 public:
  virtual ~MessageChannel() = default;
  // Returns when the call returns, which may be before the message leaves.
  virtual Task<MessageId> send(Bytes message) = 0;
  // The next message, or nothing once the deadline has passed.
  virtual Task<std::optional<ReceivedMessage>> receive(SteadyTime deadline) = 0;
  // When message `id` left, if the host stamps; the call changes no timing.
  virtual Task<std::optional<HostTime>> transmit_stamp(MessageId id, SteadyTime deadline) = 0;
  // When it passed the network card, on the card's clock.
  virtual Task<std::optional<HardwareTime>> hardware_transmit_stamp(MessageId id,
                                                                    SteadyTime deadline) = 0;
};

// A reading of the network card's clock between two readings of the system clock.
struct CrossStamp {
  HostTime before{};
  HardwareTime hardware{};
  HostTime after{};
};

// The network card's own clock (PTP hardware clock), with an oscillator of its own.
class HardwareClock {
 public:
  virtual ~HardwareClock() = default;
  virtual Task<CrossStamp> cross_stamp() = 0;
  // Adds `offset` at once.
  virtual Task<void> step(Nanoseconds offset) = 0;
  // Rate correction against its oscillator, replacing the previous one.
  virtual Task<void> adjust_frequency(double ppb) = 0;
  // The largest that adjust_frequency() takes, either way, as the driver states it
  // (PTP_CLOCK_GETCAPS). Linux, igb_ptp.c: i350, i354, i210 and i211.
  virtual double max_frequency_ppb() const { return 62'499'999; }
};

// An electrical pulse that interrupts the host; its stamps are late by the interrupt's latency.
enum class PulseLine : std::uint8_t {
  kPps,      // one pulse at each full second of GNSS time, from a receiver beside the host
  kTrigger,  // the trigger pulses of the cameras
};

struct PulseStamp {
  HostTime system{};
  SteadyTime steady{};
  // The time of the pulse by the receiver's message (kPps only); GNSS time has a zero of its own,
  // the same for all hosts.
  std::optional<Nanoseconds> gnss{};
};

class PulseInput {
 public:
  virtual ~PulseInput() = default;
  // The next pulse, or nothing once the deadline has passed. The last 1024 pulses that came while
  // no coroutine waited are kept.
  virtual Task<std::optional<PulseStamp>> next(SteadyTime deadline) = 0;
};

// A reading of a camera's clock over its control interface, between two of the host's steady clock.
struct CameraClockReading {
  DeviceStamp device;
  SteadyTime t0_steady{};
  SteadyTime t1_steady{};
};

// A frame that one of the host's own cameras delivered.
struct FrameArrival {
  std::uint32_t camera = 0;
  std::uint32_t counter = 0;
  std::uint32_t exposure_us = 0;
  DeviceStamp sensor;
  HostTime arrival{};
  SteadyTime arrival_steady{};
  // The same instant as `sensor` on the host's steady clock, if the camera stamps with that.
  std::optional<SteadyTime> sensor_steady{};
  // The newest reading of the camera's clock since its frame before, if the host reads it
  // (FrameControl::next_frame() only).
  std::optional<CameraClockReading> reading{};
};

class FrameFeed {
 public:
  virtual ~FrameFeed() = default;
  // The next frame of a camera's scored stream, or nothing once the deadline has passed. The last
  // 1024 frames that came while no coroutine waited are kept.
  virtual Task<std::optional<FrameArrival>> next(SteadyTime deadline) = 0;
};

// What a drift file says: the rate correction in use when it was written, and its likely error.
struct StoredFrequency {
  double ppb = 0;
  double error_ppb = 0;
};

class FrameControl;
class RadioClock;

class Host {
 public:
  virtual ~Host() = default;
  virtual PeerId id() const = 0;
  virtual HostClock& clock() = 0;
  virtual const SteadyClock& steady_clock() const = 0;
  // Null if the host has none. Each call returns the same object, on which one coroutine may wait
  // at a time.
  virtual HardwareClock* hardware_clock() { return nullptr; }
  virtual PulseInput* pulse_input(PulseLine /*line*/) { return nullptr; }
  virtual FrameFeed* frame_feed() { return nullptr; }
  // The clock of its Wi-Fi radio (radio_clock.h).
  virtual RadioClock* radio_clock() { return nullptr; }
  // The controls of its cameras, in the order of their numbers; none where cameras have none
  // (frame_control.h).
  virtual std::span<FrameControl* const> frame_controls() { return {}; }
  // What the clock service's last run on this host left behind; nothing on its first run, and on
  // real hosts, whose clock services begin anew with each capture.
  virtual std::optional<StoredFrequency> stored_frequency() { return std::nullopt; }
  // The channel to `peer`; both ends open it. Each call returns the same channel.
  virtual MessageChannel& open_channel(PeerId peer, Transport transport) = 0;
  virtual Task<void> sleep_for(Nanoseconds interval) = 0;
  virtual Task<void> sleep_until(HostTime at) = 0;
  // A number in [0, 1) for algorithms that spread their polls; seeded where runs must repeat.
  virtual double random_uniform() = 0;
  // Reports an exchange, or how the synchronisation of a host ended, to the recording.
  virtual void report_exchange(const Exchange& exchange) = 0;
  virtual void report_outcome(const SyncOutcome& outcome) = 0;
  // Reports that a real program of the host ended too early; only hosts that run some have a use
  // for it.
  virtual void report_program_failure(const ProgramFailure& /*failure*/) {}
  // Reports what a slave measured in a pass of its session; a host without a recording has no use
  // for it.
  virtual void report_delays(const SessionDelays& /*delays*/) {}
  // Reports what a capture alignment thinks it has reached; a host without cameras that can be
  // steered has nothing to report.
  virtual void report_alignment(const AlignmentReport& /*report*/) {}
};

}  // namespace simbench
