#include "algorithms/host_sync/ntp/ntp_kernel_loop.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench {

void NtpKernelLoop::set_frequency(double frequency) {
  frequency_ = std::clamp(frequency, -kMaxFrequency, kMaxFrequency);
}

void NtpKernelLoop::update(double offset_s, int constant, double at_s) {
  SIMBENCH_ASSERT(std::isfinite(offset_s) && std::isfinite(at_s), "an offset must be finite");
  offset_s_ = std::clamp(offset_s, -kMaxPhase, kMaxPhase);
  constant_ = std::clamp(constant, 0, kMaxConstant);
  const double mu_s = std::floor(at_s) - std::floor(at_s_);
  at_s_ = at_s;
  const double fll = mu_s > kMaxInterval ? std::ldexp(offset_s_, -kShiftFll) / mu_s : 0;
  const double pll_s = std::min(mu_s, std::ldexp(1.0, kShiftPll + 1 + constant_));
  const double pll = std::ldexp(offset_s_ * pll_s, -2 * (kShiftPll + 2 + constant_));
  set_frequency(frequency_ + fll + pll);
}

double NtpKernelLoop::residual_s(double at_s) const {
  return offset_s_ * std::exp(-(at_s - at_s_) / time_constant_s());
}

double NtpKernelLoop::time_constant_s() const {
  return -1 / std::log1p(-std::ldexp(1.0, -kShiftPll - constant_));
}

}  // namespace simbench
