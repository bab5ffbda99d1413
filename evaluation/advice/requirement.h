// What a buyer asks of a rig: a bound on a metric, "amd<0.1ms", "recall>=99%", "error<50us".
//
// The metric is one with a value for each seed (evaluation/scoring/metrics.h), by its id or without
// the unit at its end; "error" is absolute_error_ms, "recall" and "precision" those of a seed. A
// bound has a unit: s, ms, us or ns of times, % or none of shares, ppm of drifts, none of others.
// Metrics with a sign (bias) are bounded by their size. A metric that no direction improves takes
// either bound.
//
// A need may also be the tolerance of the task, "5mm at 2m/s": what moves at that speed may be seen
// at most so far apart by the cameras of a set. It becomes two requirements: exposures of a pulse
// at most 2.5 ms apart in the mean, and at least kWantedPureSets of the sets from one pulse, since
// the others are a frame period apart. "5mm at 2m/s exposed 1ms" counts the blur too: the object
// passes 2 mm while a camera exposes for 1 ms, which leaves 1.5 ms; the rig then exposes for so
// long.
//
// Refused are bounds that say nothing ("recall>0") and those that nothing can meet ("amd<0",
// "recall>100%").
//
//   const Requirement requirement = parse_requirement("amd<0.1ms");
//   requirement.limit;            // 0.1
//   requirement.is_met_by(0.05);  // true
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

inline constexpr double kWantedPureSets = 0.99;

struct Requirement {
  const Metric* metric = nullptr;
  bool is_least = false;                // values above the limit meet it; else those below
  bool takes_limit = false;             // the limit itself does
  double limit = 0;                     // in the metric's unit
  std::string text{};                   // as it was asked, or what a tolerance became
  std::string tolerance{};              // "5mm at 2m/s"; empty: it was asked for
  std::optional<double> exposure_ms{};  // of that tolerance

  // NaN meets nothing.
  bool is_met_by(double value) const;
  // The value at the bad end of a quantile `p` of the seeds, e.g. 0.95.
  double bad_quantile(const std::vector<double>& values, double p) const;
  // How many times better than asked a value is: limit / value, of a share the ratio of what is
  // missing. Infinite for a perfect value, NaN for none.
  double margin_of(double value) const;
  // The size of a value with a sign.
  double size_of(double value) const;
};

// Throws scenarios::InputError, whose message begins with "--require".
Requirement parse_requirement(const std::string& text);
// The requirements that a tolerance becomes. Throws likewise.
std::vector<Requirement> parse_tolerance(const std::string& text);
// Reads requirements and tolerances; returns at least one requirement.
std::vector<Requirement> parse_requirements(const std::vector<std::string>& texts);

// For which the rig exposes; nothing: it is not asked for. Throws for two different ones.
std::optional<double> exposure_ms_of(const std::vector<Requirement>& requirements);

}  // namespace simbench::evaluation
