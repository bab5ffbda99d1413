// chrony's poll interval: long enough that about `target` samples lie on one line.
//
// A score moves by (samples/target - 1)/target a sample, twice that downwards; a prediction that
// fails by more than the sample's distance (delay/2 + dispersion) moves it by -log2(error/distance)
// instead. Each whole point of the score is one step of the exponent, within its bounds.
//
// Source: docs/reference/host_sync.md section 2 (polltarget 8; ntp_core.c).
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_POLL_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_POLL_H_

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace simbench {

class ChronyPoll {
 public:
  // Exponents, log2 s.
  ChronyPoll(int low, int high, double target)
      : low_(low), high_(high), target_(target), exponent_(low) {}

  // `distance_s` must be > 0.
  void update(std::size_t samples, double error_s, double distance_s) {
    if (error_s > distance_s) {
      score_ -= std::log2(error_s / distance_s);
    } else {
      const double change = (static_cast<double>(samples) / target_ - 1) / target_;
      score_ += change < 0 ? 2 * change : change;
    }
    const double steps = std::floor(score_);
    const double wanted = std::clamp<double>(exponent_ + steps, low_, high_);
    score_ = wanted == exponent_ + steps ? score_ - steps : 0;
    exponent_ = static_cast<int>(wanted);
  }

  int exponent() const { return exponent_; }
  double interval_s() const { return std::ldexp(1.0, exponent_); }

 private:
  int low_;
  int high_;
  double target_;
  int exponent_;
  double score_ = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_POLL_H_
