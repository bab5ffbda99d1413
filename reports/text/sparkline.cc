#include "reports/text/sparkline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"
#include "reports/text/escaped_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

// In pixels.
constexpr double kSparkWidth = 72;
constexpr double kSparkHeight = 16;
constexpr double kSparkEdge = 1;
constexpr std::size_t kFewestValues = 3;
constexpr std::size_t kMostStrokes = 120;

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

// Where in [from, to] a value stands between `low` and `high`.
double scaled(double value, double low, double high, double from, double to) {
  return high > low ? from + (value - low) / (high - low) * (to - from) : (from + to) / 2;
}

std::string distribution_marks(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto x = [&](double value) {
    return scaled(value, values.front(), values.back(), kSparkEdge, kSparkWidth - kSparkEdge);
  };
  std::string path;
  const std::size_t step = (values.size() - 1) / kMostStrokes + 1;
  for (std::size_t i = 0; i < values.size(); i += step) {
    path += fmt::format("M{:.1f} 4V12", x(values[i]));
  }
  return fmt::format("<path class=\"each\" d=\"{}\"/><path class=\"median\" d=\"M{:.1f} 1V15\"/>",
                     path, x(evaluation::median(values)));
}

std::string series_marks(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::string path;
  for (std::size_t i = 0; i < values.size(); ++i) {
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L",
                        scaled(static_cast<double>(i), 0, static_cast<double>(values.size() - 1),
                               kSparkEdge, kSparkWidth - kSparkEdge),
                        scaled(values[i], *low, *high, kSparkHeight - kSparkEdge, kSparkEdge));
  }
  return fmt::format("<path class=\"line\" d=\"{}\"/>", path);
}

}  // namespace

Sparkline seeds_sparkline(const evaluation::Series& series_ms) {
  const std::vector<double> values = finite(series_ms.values);
  if (values.empty()) return {};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {.values = values,
          .words = fmt::format("{} from {} to {}, median {}", counted(values.size(), "seed"),
                               time_text(*low), time_text(*high), time_text(series_ms.median))};
}

std::string svg(const Sparkline& sparkline) {
  const std::vector<double> values = finite(sparkline.values);
  if (values.size() < kFewestValues) return "";
  return fmt::format(
      "<svg class=\"spark\" role=\"img\" aria-label=\"{0}\" width=\"{1}\" height=\"{2}\" "
      "viewBox=\"0 0 {1} {2}\"><title>{0}</title>{3}</svg>",
      html_escaped(sparkline.words), kSparkWidth, kSparkHeight,
      sparkline.kind == Sparkline::Kind::kSeries ? series_marks(values)
                                                 : distribution_marks(values));
}

}  // namespace simbench::reports
