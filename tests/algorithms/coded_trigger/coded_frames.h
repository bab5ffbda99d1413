// A camera's frames of a coded trigger, for the tests of those who read it.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/coded_trigger/coded_pulses.h"

namespace simbench {

inline std::shared_ptr<const CodedPulses> pulses_of(const TriggerCode& code,
                                                    bool begin_at_pulse = false) {
  return std::make_shared<const CodedPulses>(
      CodedPulses{.code = code, .exposures_begin_at_pulse = begin_at_pulse});
}

// 90 Hz, 4096 pulses, 50 us.
inline std::shared_ptr<const CodedPulses> usual_pulses() {
  return pulses_of(TriggerCode::position(from_ns(1e9 / 90), 12, from_us(50)));
}

// One every 20 ms, which is soon found: 16 pulses, 1 ms.
inline TriggerCode short_code() { return TriggerCode::position(from_ms(20), 4, from_ms(1)); }

// A frame that a camera delivers.
struct CodedFrame {
  std::int64_t pulse = 0;
  DeviceTime sensor{};
  std::uint32_t exposure_us = 0;
};

struct CodedCamera {
  std::int64_t first = 0;  // its first pulse
  double rate_ppm = 0;     // of its clock
  double offset_us = 0;    // of its clock
  double noise_us = 0;     // of its stamps, standard deviation
  double loss = 0;         // share of frames
  std::uint32_t exposure_us = 8000;
};

// The stamp of a frame that follows the pulse by a constant time, at the side that it follows.
inline DeviceTime coded_stamp(const CodedPulses& pulses, const CodedCamera& camera,
                              std::int64_t pulse, double noise_us) {
  const Nanoseconds at = pulse * pulses.code.period() + pulses.code.shift(pulse);
  const double half_us = camera.exposure_us / 2.0 * (pulses.exposures_begin_at_pulse ? 1 : -1);
  const double us = to_ns(at) * 1e-3 * (1 + camera.rate_ppm * 1e-6) + camera.offset_us + noise_us;
  return DeviceTime(Microseconds(static_cast<std::int64_t>(std::floor(us + half_us))));
}

// The frames of `count` pulses, of which some are lost.
inline std::vector<CodedFrame> coded_frames(const CodedPulses& pulses, const CodedCamera& camera,
                                            std::int64_t count, std::uint32_t seed) {
  boost::random::mt19937 random(seed);
  boost::random::normal_distribution<double> noise_us(0, 1);
  boost::random::uniform_01<double> uniform;
  std::vector<CodedFrame> frames;
  for (std::int64_t pulse = camera.first; pulse < camera.first + count; ++pulse) {
    const double noise = camera.noise_us > 0 ? camera.noise_us * noise_us(random) : 0;
    const bool is_lost = camera.loss > 0 && uniform(random) < camera.loss;
    if (is_lost || !pulses.code.is_sent(pulse)) continue;
    frames.push_back({.pulse = pulse,
                      .sensor = coded_stamp(pulses, camera, pulse, noise),
                      .exposure_us = camera.exposure_us});
  }
  return frames;
}

}  // namespace simbench
