#include "evaluation/stability/mask_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "evaluation/stability/time_error.h"

namespace simbench::evaluation {
namespace {

// What differs by less is equal: values and limits come in other units.
constexpr double kRoundingShare = 1e-9;

// A series in a band, and how long it was measured.
struct BandSeries {
  const TimeErrorSeries& series;
  double span_s;
};

bool is_of_one_tau(const MaskLimit& limit) {
  return limit.segments.front().from_s == limit.segments.back().to_s;
}

// The points of the curve at the limit's taus, in the quantity's unit.
std::vector<StabilityPoint> curve_points(const MaskLimit& limit, const TimeErrorSeries& series) {
  const QuantityFacts& facts = facts_of(limit.quantity);
  const double from_s = limit.segments.front().from_s;
  std::vector<StabilityPoint> points;
  if (is_of_one_tau(limit)) {
    const double m = std::max(std::round(from_s / series.interval_s), 1.0);
    if (std::abs(m * series.interval_s - from_s) > kTauShare * from_s) return {};
    if (m > static_cast<double>(points_in(series))) return {};
    const auto point = deviation_at(series, facts.deviation, static_cast<std::int64_t>(m));
    if (point) points.push_back(*point);
  } else {
    points = deviation_over_octaves(series, facts.deviation);
    const double to_s = limit.segments.back().to_s;
    std::erase_if(points, [&](const StabilityPoint& point) {
      return point.tau_s < from_s * (1 - kRoundingShare) ||
             point.tau_s > to_s * (1 + kRoundingShare);
    });
  }
  for (StabilityPoint& point : points) point.value *= facts.is_time() ? 1e3 : 1;
  return points;
}

bool is_beyond(double value, double allowed) { return value > allowed * (1 + kRoundingShare); }

std::string taus_text(double from_s, double to_s) {
  return from_s == to_s ? fmt::format("tau {:.6g} s", from_s)
                        : fmt::format("tau {:.6g} to {:.6g} s", from_s, to_s);
}

LimitVerdict judge_curve(const MaskLimit& limit, const BandSeries& of) {
  LimitVerdict verdict{.limit = limit};
  const bool is_mtie = limit.quantity == LimitedQuantity::kMtie;
  const double longest_s = is_mtie ? of.span_s : of.span_s / kSpansOfDeviation;
  std::vector<StabilityPoint> points = curve_points(limit, of.series);
  std::erase_if(points, [&](const StabilityPoint& point) { return point.tau_s > longest_s; });
  for (const StabilityPoint& point : points) {
    const double allowed = limit_at(limit, point.tau_s);
    const bool beyond = is_beyond(point.value, allowed);
    if (!beyond && verdict.value && point.value / allowed <= *verdict.value / verdict.allowed) {
      continue;
    }
    verdict.value = point.value;
    verdict.allowed = allowed;
    verdict.tau_s = point.tau_s;
    if (!beyond) continue;
    verdict.judgement = Judgement::kFails;
    return verdict;
  }
  const double from_s = limit.segments.front().from_s;
  const double to_s = limit.segments.back().to_s;
  const bool is_whole =
      !points.empty() &&
      (is_of_one_tau(limit) ||
       (of.series.interval_s <= from_s * (1 + kRoundingShare) && 2 * points.back().tau_s > to_s));
  if (is_whole) {
    verdict.judgement = Judgement::kPasses;
  } else {
    verdict.reason = fmt::format(
        "{}, of {}: points {:.6g} s apart over {:.6g} s",
        points.empty() ? "judged nowhere"
                       : "judged at " + taus_text(points.front().tau_s, points.back().tau_s),
        taus_text(from_s, to_s), of.series.interval_s, of.span_s);
  }
  return verdict;
}

LimitVerdict judge_size(const MaskLimit& limit, const BandSeries& of,
                        const TimeErrorSummary& time_error) {
  LimitVerdict verdict{.limit = limit};
  if (of.span_s == 0) {
    verdict.reason = "no point was judged";
    return verdict;
  }
  verdict.value = std::abs(time_error.*facts_of(limit.quantity).size);
  verdict.allowed = limit.segments.front().base;
  verdict.judgement =
      is_beyond(*verdict.value, verdict.allowed) ? Judgement::kFails : Judgement::kPasses;
  if (limit.quantity == LimitedQuantity::kMaxTe) {
    verdict.share_within = share_within(of.series, 1e-3 * verdict.allowed * (1 + kRoundingShare));
  }
  return verdict;
}

LimitVerdict judge_limit(const Stability& stability, const MaskLimit& limit) {
  std::optional<TimeErrorSeries> passed;
  if (limit.band != Band::kAll) {
    passed = filtered(stability.series, limit.band);
    if (!passed) {
      return {
          .limit = limit,
          .reason = fmt::format("points {:.6g} s apart cannot be filtered at {} Hz: {} s at most",
                                stability.interval_s, kBandEdgeHz, kLongestFilteredS)};
    }
  }
  const TimeErrorSeries& series = passed ? *passed : stability.series;
  const BandSeries of{series, static_cast<double>(points_in(series)) * series.interval_s};
  LimitVerdict verdict =
      facts_of(limit.quantity).has_tau()
          ? judge_curve(limit, of)
          : judge_size(limit, of, passed ? time_error_of(*passed) : stability.time_error);
  const double measured_s = static_cast<double>(stability.points) * stability.interval_s;
  if (verdict.judgement == Judgement::kPasses && measured_s < limit.least_s) {
    verdict.judgement = Judgement::kCannotTell;
    verdict.reason =
        fmt::format("measured over {:.6g} s, of {:.6g} s at least", measured_s, limit.least_s);
  }
  return verdict;
}

}  // namespace

MaskVerdict judge(const Stability& stability, const ClockMask& mask) {
  MaskVerdict verdict{.mask = mask.id, .title = mask.title, .judgement = Judgement::kPasses};
  for (const MaskLimit& limit : mask.limits) {
    verdict.limits.push_back(judge_limit(stability, limit));
    const Judgement judgement = verdict.limits.back().judgement;
    if (judgement == Judgement::kFails) verdict.judgement = judgement;
    if (judgement == Judgement::kCannotTell && verdict.judgement == Judgement::kPasses) {
      verdict.judgement = judgement;
    }
  }
  return verdict;
}

}  // namespace simbench::evaluation
