#include "algorithms/gathering/genlock_order.h"

#include "algorithms/ports/assert.h"

namespace simbench {

GenlockOrder::GenlockOrder(Nanoseconds period, Variant variant)
    : period_ns_(period.count()), variant_(variant) {
  SIMBENCH_ASSERT(period_ns_ > 0, "the frame period must be positive");
}

// Half a period counts up on both sides of zero; the period is positive.
std::int64_t GenlockOrder::rounded_quotient(std::int64_t elapsed_ns, std::int64_t period_ns) {
  const std::int64_t quotient = elapsed_ns / period_ns;
  const std::int64_t rest = elapsed_ns % period_ns;
  if (rest >= period_ns - period_ns / 2) return quotient + 1;
  return rest < -(period_ns / 2) ? quotient - 1 : quotient;
}

}  // namespace simbench
