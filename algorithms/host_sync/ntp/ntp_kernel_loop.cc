#include "algorithms/host_sync/ntp/ntp_kernel_loop.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench {

void KernelLoop::set_frequency(double frequency) {
  frequency_ = std::clamp(frequency, -kMaxFrequency, kMaxFrequency);
}

void KernelLoop::set_constant(int constant) { constant_ = std::clamp(constant, 0, kMaxConstant); }

KernelLoop::Mode KernelLoop::update(double offset_s, double mu_s, bool wants_fll) {
  SIMBENCH_ASSERT(std::isfinite(offset_s) && std::isfinite(mu_s), "an offset must be finite");
  offset_s_ = std::clamp(offset_s, -kMaxPhase, kMaxPhase);
  const bool is_fll = mu_s > kMaxInterval || (wants_fll && mu_s >= kMinInterval);
  const double fll = is_fll ? std::ldexp(offset_s_, -kShiftFll) / mu_s : 0;
  const double pll_s = std::min(mu_s, std::ldexp(1.0, kShiftPll + 1 + constant_));
  const double pll = std::ldexp(offset_s_ * pll_s, -2 * (kShiftPll + 2 + constant_));
  set_frequency(frequency_ + fll + pll);
  return is_fll ? Mode::kFll : Mode::kPll;
}

double KernelLoop::next_part_s() const {
  // The kernel counts 2^-32 ns: smaller parts are none, and what is left stays.
  constexpr double kLeastPart = 1e-9 / 4294967296.0;
  const double part_s = std::ldexp(offset_s_, -kShiftPll - constant_);
  return std::abs(part_s) < kLeastPart ? 0 : part_s;
}

double KernelLoop::next_second() {
  const double part_s = next_part_s();
  offset_s_ -= part_s;
  return part_s;
}

void NtpKernelLoop::update(double offset_s, int constant, double at_s) {
  SIMBENCH_ASSERT(std::isfinite(at_s), "a time must be finite");
  const double mu_s = std::floor(at_s) - std::floor(at_s_);
  at_s_ = at_s;
  loop_.set_constant(constant);
  loop_.update(offset_s, mu_s);
}

double NtpKernelLoop::residual_s(double at_s) const {
  return loop_.offset_s() * std::exp(-(at_s - at_s_) / time_constant_s());
}

double NtpKernelLoop::time_constant_s() const {
  return -1 / std::log1p(-std::ldexp(1.0, -KernelLoop::kShiftPll - loop_.constant()));
}

}  // namespace simbench
