#include "evaluation/fit/fit_remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/frames/camera_statistics.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr double kOffPeriod = 0.1;       // of a period: an interval that is not a whole number
constexpr double kMostOffPeriod = 0.25;  // of all intervals; more are a rate that varies

std::string late_remark(const StreamFit& fit, double period_ms) {
  const auto late = std::count_if(fit.excess_ms.begin(), fit.excess_ms.end(),
                                  [period_ms](double excess) { return excess > period_ms; });
  if (late == 0) return {};
  return fmt::format(
      "the order of {} that came more than a frame period late: their delays are in the table, but "
      "a stall that holds several in a row is modelled by the correlation of two alone",
      counted(static_cast<std::uint64_t>(late), "frame"));
}

std::string gap_remark(const FrameAccount& account) {
  const std::int64_t missing = account.never_exposed + account.unknown;
  if (missing == 0) return {};
  return fmt::format(
      "{} without a frame that no counter calls lost: the modelled cameras expose at every pulse",
      counted(static_cast<std::uint64_t>(missing), "frame period"));
}

std::string rate_remark(const std::vector<StampedFrame>& frames, double period_ms) {
  std::vector<double> intervals;
  std::size_t off = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    intervals.push_back(difference_ms(frames[i].sensor.count(), frames[i - 1].sensor.count()));
    const double periods = intervals.back() / period_ms;
    if (std::abs(periods - std::round(periods)) > kOffPeriod || periods < kOffPeriod) ++off;
  }
  if (static_cast<double>(off) <= kMostOffPeriod * static_cast<double>(intervals.size())) return {};
  return fmt::format(
      "a rate that varies: frames follow each other after {:.3f} to {:.3f} ms (5 to 95 %), and the "
      "model has the median, {:.3f} ms",
      quantile(intervals, 0.05), quantile(intervals, 0.95), period_ms);
}

}  // namespace

std::vector<std::string> stream_remarks(const FitStream& stream, const StreamFit& fit) {
  const double period_ms = to_ms(median_period(stream.frames));
  std::vector<std::string> remarks = {late_remark(fit, period_ms), gap_remark(fit.account),
                                      rate_remark(stream.frames, period_ms)};
  std::erase(remarks, std::string());
  if (has_one_clock(stream.frames)) {
    remarks.emplace_back(
        "its clock and its delays: arrivals and device stamps are the same, as from one column of "
        "a file, so that a drift and delays of 0 mean nothing");
  }
  return remarks;
}

}  // namespace simbench::evaluation
