#include "evaluation/scoring/pulse_table.h"

#include <cmath>
#include <limits>

#include "algorithms/ports/assert.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {
PulseTable::PulseTable(std::int64_t first_pulse, std::int64_t pulses, std::size_t sources)
    : first_pulse_(first_pulse),
      sources_(sources),
      rows_(static_cast<std::size_t>(pulses)),
      global_ns_(rows_.size() * sources, kNothing),
      reference_ns_(rows_.size() * sources) {}

void PulseTable::shift(Nanoseconds by) {
  for (std::int64_t& cell : global_ns_) {
    if (cell != kNothing) cell = clamped_ns(GlobalTime(Nanoseconds(cell) + by));
  }
}

void HostErrors::add(std::span<const Nanoseconds> errors) {
  SIMBENCH_ASSERT(errors.size() == sum_ms_.size(), "the truth of a pulse has an error per host");
  for (std::size_t host = 0; host < errors.size(); ++host) {
    const double error_ms = to_ms(errors[host]);
    sum_ms_[host] += error_ms;
    if (host > 0) absolute_sum_ms_ += std::abs(error_ms);
  }
  ++pulses_;
}

double HostErrors::mean_absolute_ms() const {
  if (pulses_ == 0 || sum_ms_.size() < 2) return kNan;
  return absolute_sum_ms_ /
         (static_cast<double>(pulses_) * static_cast<double>(sum_ms_.size() - 1));
}

std::vector<double> HostErrors::signed_means_ms() const {
  std::vector<double> means(sum_ms_.size(), kNan);
  for (std::size_t host = 0; host < means.size() && pulses_ > 0; ++host) {
    means[host] = sum_ms_[host] / static_cast<double>(pulses_);
  }
  return means;
}

}  // namespace simbench::evaluation
