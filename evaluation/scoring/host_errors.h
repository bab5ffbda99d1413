// Mean errors of the host clocks over the evaluated pulses, from the truth.
//
// The error of a host is its system clock minus the master's at the instant of a pulse. The master
// (host 0) defines global time: its error is 0 and does not count in the mean. NaN: no slave, or no
// pulse with truth.
#ifndef SIMBENCH_EVALUATION_SCORING_HOST_ERRORS_H_
#define SIMBENCH_EVALUATION_SCORING_HOST_ERRORS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::evaluation {

class HostErrors {
 public:
  explicit HostErrors(std::size_t hosts) : sum_ms_(hosts) {}

  // One value per host.
  void add(std::span<const Nanoseconds> errors);

  double mean_absolute_ms() const;              // over pulses and slaves
  std::vector<double> signed_means_ms() const;  // over pulses, by host

 private:
  std::vector<double> sum_ms_;
  double absolute_sum_ms_ = 0;
  std::int64_t pulses_ = 0;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_HOST_ERRORS_H_
