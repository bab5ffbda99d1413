// A published figure of one metric, which results put beside the seeds of a pipeline's row.
//
// A figure is a number in the metric's unit, with what it says: at most so much ("below 250 us"),
// this value, or at least so much. Exactly one of the three is stated
// (scenarios/published_checks.h). The comparison: evaluation/scoring/published_figures.h.
//
//   const PublishedFigure claim{.pipeline = "libsoftwaresync",
//                               .metric = "exposure_spread_median_ms",
//                               .at_most = 0.25,
//                               .conditions = "phones on Wi-Fi",
//                               .source = "Ansari et al. 2019"};
//   claim.number();  // 0.25
#ifndef SIMBENCH_SCENARIOS_PUBLISHED_FIGURE_H_
#define SIMBENCH_SCENARIOS_PUBLISHED_FIGURE_H_

#include <optional>
#include <string>

namespace simbench::scenarios {

struct PublishedFigure {
  std::string pipeline{};
  std::string metric{};  // the id of a series (evaluation/scoring/metrics.h)
  std::optional<double> at_most{};
  std::optional<double> value{};
  std::optional<double> at_least{};
  std::string conditions{};  // what was measured, on what
  std::string source{};

  // The one that is stated, and the name of that member.
  const char* number_name() const {
    if (value) return "value";
    return at_most ? "at_most" : "at_least";
  }
  double number() const { return at_most.value_or(value.value_or(at_least.value_or(0))); }
};

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_PUBLISHED_FIGURE_H_
