#include "algorithms/gathering/genlock_order.h"

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Half a period counts up on both sides of zero; `period` is positive.
std::int64_t rounded_quotient(std::int64_t elapsed, std::int64_t period) {
  const std::int64_t quotient = elapsed / period;
  const std::int64_t rest = elapsed % period;
  if (rest >= period - period / 2) return quotient + 1;
  return rest < -(period / 2) ? quotient - 1 : quotient;
}

}  // namespace

GenlockOrder::GenlockOrder(Nanoseconds period, Variant variant)
    : period_ns_(period.count()), variant_(variant) {
  SIMBENCH_ASSERT(period_ns_ > 0, "the frame period must be positive");
}

std::int64_t GenlockOrder::next(DeviceTime sensor) {
  if (!anchor_) anchor_ = sensor;
  const std::int64_t elapsed_ns = nanoseconds_of(sensor) - nanoseconds_of(*anchor_);
  const std::int64_t index = anchor_index_ + rounded_quotient(elapsed_ns, period_ns_);
  if (variant_ == Variant::kReanchored) {
    anchor_ = sensor;
    anchor_index_ = index;
  }
  return index;
}

}  // namespace simbench
