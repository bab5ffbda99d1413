#include "sim/host/drift_files.h"

#include <chrono>
#include <cmath>

#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kDriftFile("host: drift file");
constexpr std::chrono::hours kWindow(1);

// The frequency of the oscillator when the file was written.
double frequency_then(const OscillatorModel& oscillator, TrueTime now, Nanoseconds age) {
  const double warmth_now = oscillator.mean_frequency_by_temperature(now - kWindow, now);
  const double warmth_then =
      oscillator.mean_frequency_by_temperature(now - age - kWindow, now - age);
  return oscillator.mean_frequency(now - kWindow, now) - warmth_now + warmth_then;
}

}  // namespace

std::optional<StoredFrequency> DriftFiles::read(PeerId host, TrueTime now) const {
  if (!hosts_.drift_file) return std::nullopt;
  const scenarios::DriftFile& file = *hosts_.drift_file;
  const double age_s = file.age_h * to_seconds(std::chrono::hours(1));
  const Nanoseconds age = from_seconds(age_s);
  const double walk_ppb = hosts_.clock.oscillator.random_walk_ppb_per_sqrt_s * std::sqrt(age_s);
  const double of_master = frequency_then(clocks_[0].oscillator(), now, age);
  const double of_host = frequency_then(clocks_[host].oscillator(), now, age);
  RandomStream draw(run_seed_, kDriftFile, host);
  const double error_ppb = draw.normal(file.error_ppb);
  const double walked_ppb = draw.normal(walk_ppb);
  return StoredFrequency{
      .ppb = ((1 + of_master) / (1 + of_host) - 1) * 1e9 + error_ppb + walked_ppb,
      .error_ppb = file.error_ppb};
}

}  // namespace simbench::sim
