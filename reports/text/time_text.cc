#include "reports/text/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

constexpr ShownUnit kShownUnits[] = {
    {999.5, 1e-3, "s"}, {0.09995, 1, "ms"}, {0.9995e-4, 1e3, "us"}, {0, 1e6, "ns"}};

}  // namespace

const ShownUnit& time_unit_of(double ms) {
  return *std::find_if(std::begin(kShownUnits), std::end(kShownUnits) - 1,
                       [ms](const ShownUnit& unit) { return std::abs(ms) >= unit.from_ms; });
}

std::string time_text(double ms) {
  if (!std::isfinite(ms)) return "-";
  if (ms == 0) return "0";
  const ShownUnit& unit = time_unit_of(ms);
  return fmt::format("{} {}", number_text(ms * unit.per_ms), unit.name);
}

std::string tick_text(double ms) {
  const ShownUnit& unit = time_unit_of(ms);
  return fmt::format("{:g} {}", ms * unit.per_ms, unit.name);
}

std::string time_band_text(double low_ms, double high_ms) {
  if (!std::isfinite(low_ms) || !std::isfinite(high_ms)) return "-";
  if (low_ms == 0 && high_ms == 0) return "[0, 0]";
  const ShownUnit& unit = time_unit_of(std::max(std::abs(low_ms), std::abs(high_ms)));
  return fmt::format("[{}, {}] {}", number_text(low_ms * unit.per_ms),
                     number_text(high_ms * unit.per_ms), unit.name);
}

std::string time_change_text(double from_ms, double to_ms) {
  if (!std::isfinite(from_ms) || !std::isfinite(to_ms)) return "-";
  const double large_ms = std::max(std::abs(from_ms), std::abs(to_ms));
  constexpr double kFar = 1000;  // one unit would need a power of ten
  if (kFar * std::min(std::abs(from_ms), std::abs(to_ms)) < large_ms) {
    return fmt::format("from {} to {}", time_text(from_ms), time_text(to_ms));
  }
  const ShownUnit& unit = time_unit_of(large_ms);
  return fmt::format("from {} to {} {}", number_text(from_ms * unit.per_ms),
                     number_text(to_ms * unit.per_ms), unit.name);
}

}  // namespace simbench::reports
