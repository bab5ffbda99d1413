#include "evaluation/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "evaluation/frames/camera_statistics.h"
#include "laws/lower_hull.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kParts = 8;

void check_stamps(const std::string& camera, const FitStream& stream) {
  const std::vector<StampedFrame>& frames = stream.frames;
  if (frames.size() < kFewestFrames) {
    throw FitError(fmt::format("camera {}, {}: found {}, a fit needs {} at least", camera,
                               stream.kind, counted(frames.size(), "frame"), kFewestFrames));
  }
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool device_back = frames[i].sensor <= frames[i - 1].sensor;
    if (!device_back && frames[i].arrival >= frames[i - 1].arrival) continue;
    const char* what = device_back ? "device stamp" : "arrival";
    const auto step_ms = device_back ? to_ms(frames[i].sensor - frames[i - 1].sensor)
                                     : to_ms(frames[i].arrival - frames[i - 1].arrival);
    throw FitError(fmt::format(
        "camera {}, {}: found {} {:.3f} ms after the one before it (frame counter {}), allowed "
        "stamps that ascend; cut the recording there",
        camera, stream.kind, what, step_ms, frames[i].counter));
  }
}

// (device stamp, arrival less device stamp), both from the first frame on.
std::vector<LinePoint> points_of(const std::vector<StampedFrame>& frames) {
  std::vector<LinePoint> points;
  points.reserve(frames.size());
  for (const StampedFrame& frame : frames) {
    const std::int64_t device_ns = (frame.sensor - frames.front().sensor).count();
    const std::int64_t arrival_ns = (frame.arrival - frames.front().arrival).count();
    points.push_back({.x = device_ns, .y = arrival_ns - device_ns});
  }
  return points;
}

// The hull line of every `step`-th point from `first` on.
SupportLine hull_line(std::span<const LinePoint> points, std::size_t first = 0,
                      std::size_t step = 1) {
  LowerHull hull;
  for (std::size_t i = first; i < points.size(); i += step) hull.add(points[i]);
  return middle_line(hull.vertices());
}

double skew_error_ppm(std::span<const LinePoint> points) {
  std::vector<double> skews;
  for (std::size_t part = 0; part < kParts; ++part) {
    skews.push_back(skew_of_slope_ppm(hull_line(points, part, kParts).slope));
  }
  return standard_deviation(skews) / std::sqrt(static_cast<double>(kParts));
}

double height_ms(const SupportLine& line, LinePoint point) {
  return (static_cast<double>(point.y) - line.at(point.x)) * 1e-6;
}

double rise_ms(std::span<const LinePoint> points, const SupportLine& line) {
  constexpr std::size_t kTenths = 10;
  double worst = 0;
  for (std::size_t i = 0; i < kTenths; ++i) {
    const std::size_t begin = i * points.size() / kTenths;
    const std::size_t end = (i + 1) * points.size() / kTenths;
    double least = height_ms(line, points[begin]);
    for (const LinePoint& point : points.subspan(begin, end - begin)) {
      least = std::min(least, height_ms(line, point));
    }
    worst = std::max(worst, least);
  }
  return worst;
}

// The height of each frame above the hull of its block.
std::vector<double> excess_of(std::span<const LinePoint> points, double span_s) {
  const std::size_t by_frames = points.size() / kBlockFrames;
  const auto by_time = static_cast<std::size_t>(span_s / kBlockS);
  const std::size_t blocks = std::max<std::size_t>(1, std::min(by_frames, by_time));
  std::vector<double> excess_ms;
  excess_ms.reserve(points.size());
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t begin = i * points.size() / blocks;
    const std::size_t end = (i + 1) * points.size() / blocks;
    const std::span<const LinePoint> block = points.subspan(begin, end - begin);
    const SupportLine line = hull_line(block);
    for (const LinePoint& point : block) excess_ms.push_back(std::max(0.0, height_ms(line, point)));
  }
  return excess_ms;
}

// Ranks from 0 on; equal values share their mean rank.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&values](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    const double rank = static_cast<double>(i + end - 1) / 2;
    for (; i < end; ++i) ranks[order[i]] = rank;
  }
  return ranks;
}

// Pearson's.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double aa = 0;
  double bb = 0;
  double ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : kNan;
}

constexpr std::int64_t kFewestFramePairs = 30;

// The mean of the streams' correlations, weighted by their pairs.
std::optional<FittedValue> correlation_of(const std::vector<StreamFit>& streams) {
  double sum = 0;
  std::int64_t pairs = 0;
  for (const StreamFit& stream : streams) {
    if (std::isnan(stream.rank_correlation)) continue;
    sum += stream.rank_correlation * static_cast<double>(stream.pairs);
    pairs += stream.pairs;
  }
  if (pairs < kFewestFramePairs) return std::nullopt;
  const double spearman = sum / static_cast<double>(pairs);
  const double per_rank = std::numbers::pi / 3 * std::cos(std::numbers::pi / 6 * spearman);
  return FittedValue{2 * std::sin(std::numbers::pi / 6 * spearman),
                     per_rank / std::sqrt(static_cast<double>(pairs))};
}

std::vector<FittedValue> skews_of(const FitInput& input, const std::vector<StreamFit>& streams) {
  std::vector<FittedValue> skews;
  for (std::size_t camera = 0; camera < input.cameras.size(); ++camera) {
    const StreamFit* best = nullptr;
    for (const StreamFit& stream : streams) {
      if (stream.camera != camera) continue;
      if (best == nullptr || stream.skew_error_ppm < best->skew_error_ppm) best = &stream;
    }
    if (best == nullptr) {
      throw FitError(fmt::format("camera {}: found no frames, a fit needs {} at least",
                                 input.cameras[camera].name, kFewestFrames));
    }
    skews.push_back({best->skew_ppm, best->skew_error_ppm});
  }
  return skews;
}

}  // namespace

double successive_rank_correlation(const std::vector<double>& values,
                                   const std::vector<bool>& follows) {
  const std::vector<double> ranks = ranks_of(values);
  std::vector<double> before;
  std::vector<double> after;
  for (std::size_t i = 1; i < ranks.size(); ++i) {
    if (!follows[i]) continue;
    before.push_back(ranks[i - 1]);
    after.push_back(ranks[i]);
  }
  return correlation(before, after);
}

StreamFit fit_stream(const std::string& camera, const FitStream& stream) {
  check_stamps(camera, stream);
  const std::vector<StampedFrame>& frames = stream.frames;
  const std::vector<LinePoint> points = points_of(frames);
  const SupportLine line = hull_line(points);
  const CameraStatistics statistics = camera_statistics(frames);
  StreamFit fit;
  fit.camera = stream.camera;
  fit.kind = stream.kind;
  fit.frames = statistics.frames;
  fit.account = stream.account;
  fit.span_s = statistics.span_s;
  fit.skew_ppm = skew_of_slope_ppm(line.slope);
  fit.skew_error_ppm = skew_error_ppm(points);
  if (is_doubtful_drift(fit.skew_ppm)) {
    throw FitError(
        fmt::format("camera {}, {}: found a drift of {:.0f} ppm, allowed that of a camera's clock, "
                    "some tens of "
                    "ppm; are both stamps milliseconds of one camera?",
                    camera, stream.kind, fit.skew_ppm));
  }
  fit.excess_ms = excess_of(points, fit.span_s);
  fit.rise_ms = rise_ms(points, line);
  std::vector<bool> follows(frames.size(), false);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    follows[i] = frames[i].counter == frames[i - 1].counter + 1;
    fit.pairs += follows[i] ? 1 : 0;
  }
  fit.rank_correlation = successive_rank_correlation(fit.excess_ms, follows);
  return fit;
}

double skew_of_slope_ppm(double slope) { return -slope / (1 + slope) * 1e6; }

std::vector<double> quantile_table(const std::vector<double>& sorted) {
  const std::size_t size = std::min(kLongestTable, sorted.size());
  std::vector<double> table;
  for (std::size_t i = 0; i < size; ++i) {
    const auto last = static_cast<double>(std::max<std::size_t>(size - 1, 1));
    table.push_back(quantile_of_sorted(sorted, static_cast<double>(i) / last));
  }
  return table;
}

RigFit fit_rig(const FitInput& input) {
  if (input.cameras.empty()) throw FitError("the recording has no cameras");
  RigFit fit;
  for (const FitStream& stream : input.streams) {
    fit.streams.push_back(fit_stream(input.cameras[stream.camera].name, stream));
    const StreamFit& added = fit.streams.back();
    fit.frames += added.frames;
    if (stream.counted) {
      if (!fit.drops) fit.drops.emplace();
      fit.drops->lost += added.account.lost;
      fit.drops->counted += added.account.delivered + added.account.lost;
    }
    fit.excess_ms.insert(fit.excess_ms.end(), added.excess_ms.begin(), added.excess_ms.end());
  }
  fit.skew_ppm = skews_of(input, fit.streams);
  std::sort(fit.excess_ms.begin(), fit.excess_ms.end());
  fit.delivery_quantiles_ms = quantile_table(fit.excess_ms);
  fit.correlation = correlation_of(fit.streams);
  if (fit.drops) fit.drops->interval = binomial_interval(fit.drops->lost, fit.drops->counted);
  fit.network = fit_exchanges(input);
  return fit;
}

}  // namespace simbench::evaluation
