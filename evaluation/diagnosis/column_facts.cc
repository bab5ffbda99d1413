#include "evaluation/diagnosis/column_facts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "evaluation/frames/camera_statistics.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kFewestOfColumn = 20;
constexpr double kHalfExplained = 0.5;

ColumnRange range_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.size() < kFewestOfColumn) return {};
  std::ranges::sort(values);
  return {quantile_of_sorted(values, 0.01), quantile_of_sorted(values, 0.5),
          quantile_of_sorted(values, 0.99)};
}

ColumnRange above_least(std::vector<double> values) {
  const ColumnRange range = range_of(std::move(values));
  return {0, range.middle - range.low, range.high - range.low};
}

double rate_of(const std::vector<double>& bytes, std::span<const StampedFrame> frames) {
  const double span_s =
      difference_ms(frames.back().arrival.count(), frames.front().arrival.count()) * 1e-3;
  double sum = 0;
  for (const double size : bytes) sum += std::isnan(size) ? 0 : size;
  return sum > 0 && span_s > 0 ? sum / span_s : kNan;
}

// The slope of lateness over size, if sizes explain half of the lateness.
double ns_per_byte(const std::vector<double>& bytes, std::span<const double> offsets_ms) {
  std::vector<double> sizes;
  std::vector<double> lateness;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (std::isnan(bytes[i])) continue;
    sizes.push_back(bytes[i]);
    lateness.push_back(offsets_ms[i]);
  }
  if (sizes.size() < kFewestOfColumn) return kNan;
  const FittedLine line = fit_line(sizes, lateness);
  const double explained = line.slope * standard_deviation(sizes) / standard_deviation(lateness);
  return explained * explained >= kHalfExplained && line.slope > 0 ? line.slope * 1e6 : kNan;
}

}  // namespace

ColumnFacts column_facts(const FrameColumns& columns, std::span<const StampedFrame> frames,
                         std::span<const double> offsets_ms) {
  ColumnFacts facts;
  std::vector<double> exposures = columns.exposure_us;
  for (double& exposure : exposures) exposure *= 1e-3;
  facts.exposure_ms = range_of(std::move(exposures));
  facts.temperature_c = range_of(columns.temperature_c);
  if (!columns.backend_ms.empty()) {
    std::vector<double> to;
    std::vector<double> from;
    for (std::size_t i = 0; i < offsets_ms.size(); ++i) {
      to.push_back(offsets_ms[i] + columns.backend_ms[i]);
      from.push_back(-columns.backend_ms[i]);
    }
    facts.to_backend_ms = above_least(std::move(to));
    facts.from_backend_ms = above_least(std::move(from));
  }
  if (!columns.bytes.empty()) {
    facts.bytes_per_s = rate_of(columns.bytes, frames);
    facts.ns_per_byte = ns_per_byte(columns.bytes, offsets_ms);
  }
  return facts;
}

}  // namespace simbench::evaluation
