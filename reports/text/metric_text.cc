#include "reports/text/metric_text.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

// Milliseconds in one of its units; 0 for a metric that is no duration.
double unit_ms(const evaluation::Metric& metric) {
  const std::string_view unit = metric.unit;
  return unit == "ms" ? 1 : unit == "s" ? 1000 : 0;
}

}  // namespace

std::string metric_text(const evaluation::Metric& metric, double value) {
  if (metric.is_share()) return share_text(value);
  if (metric.is_count() && std::isfinite(value)) return count_text(std::llround(value));
  return difference_text(metric, value);
}

std::string difference_text(const evaluation::Metric& metric, double difference) {
  if (!std::isfinite(difference)) return "-";
  if (metric.is_share()) return number_text(100 * difference) + " %";
  const double ms = unit_ms(metric);
  return ms > 0 ? time_text(ms * difference) : number_text(difference);
}

std::string interval_text(const evaluation::Metric& metric, double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "-";
  if (const double ms = unit_ms(metric); ms > 0) return time_band_text(ms * low, ms * high);
  return fmt::format("[{}, {}]{}", number_text(shown_value(metric, low)),
                     number_text(shown_value(metric, high)), metric.is_share() ? " %" : "");
}

double shown_value(const evaluation::Metric& metric, double value) {
  return metric.is_share() ? 100 * value : value;
}

}  // namespace simbench::reports
