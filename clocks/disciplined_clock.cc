#include "clocks/disciplined_clock.h"

#include <fmt/format.h>

namespace simbench::clocks {
namespace {

constexpr double kMaxRate = 0.5;

}  // namespace

void check_rate(double ppb) {
  if (std::isfinite(ppb) && std::abs(ppb) < kMaxRate * 1e9) return;
  throw ClockError(
      fmt::format("clock: found a rate of {} ppb, allowed less than {:.0f} ppb in either direction",
                  ppb, kMaxRate * 1e9));
}

void check_slew_rate(double ppb) {
  check_rate(ppb);
  if (ppb > 0) return;
  throw ClockError(fmt::format("clock: found a slew at {} ppb, allowed a rate above 0", ppb));
}

}  // namespace simbench::clocks
