// The access point's beacons: when those come that its stations listen to.
//
// They come evenly in true time, since ever; their phase is one draw per run. With power save
// stations wake for those with a DTIM alone, one of dtim_period, and only these are numbered.
//
// Left out: beacons that wait for a busy channel, whose stamps say so, and the drift of the access
// point's schedule. Source: IEEE 802.11-2020, 11.1.3 and 11.2.3; scenario /network/wifi.
//
//   const Beacons beacons(*scenario.network.wifi, seed);
//   const TrueTime wakes = beacons.at(beacons.last(now) + 1);
#pragma once

#include <cstdint>

#include "algorithms/ports/time.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class Beacons {
 public:
  Beacons(const scenarios::Wifi& wifi, std::uint64_t run_seed) {
    const double step_ms =
        interval_ms(wifi) * static_cast<double>(wifi.power_save ? wifi.power_save->dtim_period : 1);
    step_ = from_ms(step_ms);
    phase_ = from_ms(RandomStream(run_seed, kPhase).uniform(0, step_ms));
  }

  // The number of the last one at or before `at`.
  std::int64_t last(TrueTime at) const {
    return floor_div((at.time_since_epoch() - phase_).count(), step_.count());
  }
  TrueTime at(std::int64_t number) const { return TrueTime(phase_ + number * step_); }

 private:
  static constexpr ComponentKey kPhase{"wifi: phase of the beacons"};
  static constexpr double kUsualIntervalMs = 102.4;

  static double interval_ms(const scenarios::Wifi& wifi) {
    if (wifi.power_save) return wifi.power_save->beacon_interval_ms;
    return wifi.tsf ? wifi.tsf->beacon_interval_ms.value_or(kUsualIntervalMs) : kUsualIntervalMs;
  }

  Nanoseconds step_{};
  Nanoseconds phase_{};
};

}  // namespace simbench::sim
