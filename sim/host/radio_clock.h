// The clocks of Wi-Fi radios: the access point's, and a station's copy of it.
//
//  - RadioCounter: what a radio counts, on the oscillator of its host.
//  - AccessPoint: its counter (the TSF) and what its beacons say of it.
//  - SimRadioClock: a host's radio as its programs use it (algorithms/ports/radio_clock.h).
//
// TSF. A beacon carries the access point's counter with an error N(beacon_stamp_sigma_us), rounded
// down to resolution_us; one draw a beacon, the same for all that hear it. A station that hears it
// sets its copy to it, with an error N(receive_sigma_us) of its own, and counts on by its own
// oscillator until the next one; it misses each with beacon_loss_probability, independently. Where
// two oscillators are d ppm apart, the copy is thus d * interval / 2 wrong on average. A call reads
// the copy read_before after its begin, returns read_after later, and occupies the CPU meanwhile.
//
// FTM. A session takes session_ms and has its exchanges at even spaces; the answer leaves SIFS and
// a preamble after the frame came. Stamps of transmissions are exact, those of receptions late by
// N(stamp_sigma_ns), by the device's N(calibration_sigma_ns) and by the reflections' |N(
// multipath_sigma_ns)| of that link and direction; all are rounded down to stamp_resolution_ns. The
// offset of one exchange has therefore the deviation stamp_sigma_ns / sqrt(2), and a constant error
// of half the difference of both ends' lateness. The access point's stamps are
// access_point_offset_ns ahead of its counter.
//
// Left out: the flight (it cancels), the airtime of sessions and beacons, that a session keeps a
// station awake, retries of its frames, noise that depends on the signal's strength, and errors
// that grow where something moves.
//
// Counters begin anywhere within an hour. All draws are keyed by device, beacon, session and
// number of the call: a program that asks more changes no other's. Deterministic; a call costs an
// event. Source: IEEE 802.11-2020, 11.1.3 and 11.21.6; docs/reference/wifi_time.md; scenario
// /network/wifi/tsf and ftm.
//
//   const AccessPoint access_point(*scenario.network.wifi, seed, clocks);
//   const TsfTime counts = access_point.at(engine.now());
//
//   SimRadioClock radio(host, access_point);
//   const std::optional<TsfReading> reading = co_await radio.read_tsf();
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "algorithms/ports/radio_clock.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/random.h"
#include "sim/host/host_clocks.h"
#include "sim/host/message_stack.h"
#include "sim/network/beacons.h"

namespace simbench::sim {

class SimHost;

// The counter of a device's radio, which began when the device's steady clock read `-zero`.
class RadioCounter {
 public:
  RadioCounter(std::uint64_t run_seed, PeerId device);
  HardwareTime at(TrueTime t, const SystemClock& clock) const {
    return HardwareTime(clock.steady(t).time_since_epoch() + zero_);
  }

 private:
  Nanoseconds zero_;
};

class AccessPoint {
 public:
  // An access point that is no host is a device with this number.
  static constexpr PeerId kNoHost = 0xFFFFFFFF;

  // `wifi` and `clocks` must outlive this; the clock of the access point's host is in `clocks` when
  // it is first read.
  AccessPoint(const scenarios::Wifi& wifi, std::uint64_t run_seed,
              const std::deque<SystemClock>& clocks);

  const scenarios::Wifi& wifi() const { return wifi_; }
  // Its host, or kNoHost.
  PeerId device() const { return device_; }
  bool has_radio(PeerId host) const;

  TsfTime at(TrueTime t) const { return TsfTime(counter_.at(t, clock()).time_since_epoch()); }
  // What a station's copy of it reads at `t`, by the last beacon that it has heard; nothing if it
  // has heard none of the last kBeaconsRemembered. Only with /network/wifi/tsf.
  std::optional<TsfTime> copy_at(TrueTime t, PeerId station, const SystemClock& clock) const;

 private:
  static constexpr int kBeaconsRemembered = 1000;

  const SystemClock& clock() const { return own_ ? *own_ : clocks_[device_]; }
  std::optional<std::int64_t> last_heard(TrueTime t, PeerId station) const;

  const scenarios::Wifi& wifi_;
  std::uint64_t run_seed_;
  const std::deque<SystemClock>& clocks_;
  PeerId device_;
  RadioCounter counter_;
  std::optional<SystemClock> own_;  // of an access point that is no host
  Beacons beacons_;
};

class SimRadioClock final : public RadioClock {
 public:
  // Both must outlive the radio.
  SimRadioClock(SimHost& host, const AccessPoint& access_point);

  bool is_access_point() const override;
  Task<std::optional<TsfReading>> read_tsf() override;
  Task<std::optional<CounterReading>> read_counter() override;
  Task<std::vector<FtmExchange>> measure_ftm() override;

 private:
  // The parts of a call that reads a counter.
  struct ReadLaw {
    ReadLaw(const scenarios::DelayLaw& to_counter, const scenarios::DelayLaw& from_counter,
            std::uint64_t run_seed, ComponentKey to_key, ComponentKey from_key, PeerId host)
        : before(to_counter, run_seed, to_key, host, 1),
          after(from_counter, run_seed, from_key, host, 1) {}
    DelayProcess before;
    DelayProcess after;
    std::uint64_t calls = 0;
  };
  struct Call {
    Cpu::Turn turn;
    TrueTime touch;  // the counter is read
  };
  // How late a device stamps what comes over this link.
  struct Lateness {
    double station_ns = 0;
    double access_point_ns = 0;
  };

  Call begin_call(ReadLaw& law);
  Task<void> wait_until(TrueTime at);
  Lateness lateness(const scenarios::WifiFtm& ftm) const;
  // The exchange whose frame leaves at `at`; nothing if it is missing.
  std::optional<FtmExchange> exchange(TrueTime at, RandomStream& draw) const;

  SimHost& host_;
  const AccessPoint& access_point_;
  RadioCounter counter_;
  std::optional<ReadLaw> tsf_reads_;      // with /network/wifi/tsf
  std::optional<ReadLaw> counter_reads_;  // with /network/wifi/ftm
  Lateness late_;
  std::uint64_t sessions_ = 0;
  std::string label_;
};

}  // namespace simbench::sim
