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

// What follows the number of a metric that is no duration.
const char* unit_text(const evaluation::Metric& metric) {
  return metric.is_share() ? " %" : metric.unit == std::string_view("ppm") ? " ppm" : "";
}

}  // namespace

std::string metric_text(const evaluation::Metric& metric, double value) {
  if (metric.is_share()) return share_text(value);
  if (metric.is_count() && std::isfinite(value)) return count_text(std::llround(value));
  return difference_text(metric, value);
}

std::string difference_text(const evaluation::Metric& metric, double difference) {
  if (!std::isfinite(difference)) return "-";
  if (const double ms = unit_ms(metric); ms > 0) return time_text(ms * difference);
  return number_text(shown_value(metric, difference)) + unit_text(metric);
}

std::string interval_text(const evaluation::Metric& metric, double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "-";
  if (const double ms = unit_ms(metric); ms > 0) return time_band_text(ms * low, ms * high);
  return fmt::format("[{}, {}]{}", number_text(shown_value(metric, low)),
                     number_text(shown_value(metric, high)), unit_text(metric));
}

double shown_value(const evaluation::Metric& metric, double value) {
  return metric.is_share() ? 100 * value : value;
}

}  // namespace simbench::reports
