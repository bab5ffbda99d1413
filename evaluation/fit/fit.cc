#include "evaluation/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "evaluation/fit/fit_remarks.h"
#include "evaluation/fit/rate_line.h"
#include "evaluation/frames/camera_statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr double kNotDelayed = 0.25;  // the lower quartile

// The points (device stamp, arrival less device stamp), both from the first frame on.
struct StampPoints {
  std::vector<double> device_ms;
  std::vector<double> distance_ms;

  std::span<const double> device(std::size_t begin, std::size_t end) const {
    return std::span(device_ms).subspan(begin, end - begin);
  }
  std::span<const double> distance(std::size_t begin, std::size_t end) const {
    return std::span(distance_ms).subspan(begin, end - begin);
  }
};

StampPoints stamp_points(const std::vector<StampedFrame>& frames) {
  StampPoints points;
  for (const StampedFrame& frame : frames) {
    const std::int64_t device_ns = (frame.sensor - frames.front().sensor).count();
    const std::int64_t arrival_ns = (frame.arrival - frames.front().arrival).count();
    points.device_ms.push_back(difference_ms(device_ns, 0));
    points.distance_ms.push_back(difference_ms(arrival_ns, device_ns));
  }
  return points;
}

// The heights of the frames [begin, end) over a line.
std::vector<double> heights_ms(const StampPoints& points, const RateLine& line, std::size_t begin,
                               std::size_t end) {
  std::vector<double> heights;
  heights.reserve(end - begin);
  for (std::size_t i = begin; i < end; ++i) {
    heights.push_back(points.distance_ms[i] - line.at(points.device_ms[i]));
  }
  return heights;
}

double rise_ms(const StampPoints& points, const RateLine& line) {
  constexpr std::size_t kTenths = 10;
  const std::size_t size = points.device_ms.size();
  const double usual = quantile(heights_ms(points, line, 0, size), kNotDelayed);
  double worst = 0;
  for (std::size_t i = 0; i < kTenths; ++i) {
    std::vector<double> heights =
        heights_ms(points, line, i * size / kTenths, (i + 1) * size / kTenths);
    worst = std::max(worst, std::abs(quantile(std::move(heights), kNotDelayed) - usual));
  }
  return worst;
}

// The height of each frame over the line of its block, from the lowest on.
std::vector<double> excess_of(const StampPoints& points, double span_s) {
  const std::size_t size = points.device_ms.size();
  const std::size_t by_frames = size / kBlockFrames;
  const auto by_time = static_cast<std::size_t>(span_s / kBlockS);
  const std::size_t blocks = std::max<std::size_t>(1, std::min(by_frames, by_time));
  std::vector<double> excess_ms;
  excess_ms.reserve(size);
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t begin = i * size / blocks;
    const std::size_t end = (i + 1) * size / blocks;
    const RateLine line = rate_line(points.device(begin, end), points.distance(begin, end));
    const std::vector<double> heights = heights_ms(points, line, begin, end);
    const double lowest = *std::min_element(heights.begin(), heights.end());
    for (const double height : heights) excess_ms.push_back(height - lowest);
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

// Values less their mean, over their standard deviation; nothing if all are the same.
std::vector<double> standardised(std::vector<double> values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (double& value : values) {
    value -= mean;
    squares += value * value;
  }
  if (!(squares > 0)) return {};
  const double deviation = std::sqrt(squares / static_cast<double>(values.size()));
  for (double& value : values) value /= deviation;
  return values;
}

// Pearson's. The error is that of the sums of the influences of the pairs, over successive parts.
FittedValue correlation(std::vector<double> before, std::vector<double> after) {
  const std::vector<double> a = standardised(std::move(before));
  const std::vector<double> b = standardised(std::move(after));
  if (a.empty() || b.empty()) return {.value = kNan, .error = kNan};
  const auto size = static_cast<double>(a.size());
  double r = 0;
  for (std::size_t i = 0; i < a.size(); ++i) r += a[i] * b[i] / size;
  double squares = 0;
  for (std::size_t part = 0; part < kErrorBlocks; ++part) {
    double influence = 0;
    for (std::size_t i = part * a.size() / kErrorBlocks; i < (part + 1) * a.size() / kErrorBlocks;
         ++i) {
      influence += a[i] * b[i] - r * (a[i] * a[i] + b[i] * b[i]) / 2;
    }
    squares += influence * influence;
  }
  constexpr auto kBlocks = static_cast<double>(kErrorBlocks);
  return {.value = r,
          .error = std::sqrt(squares * kBlocks / (kBlocks - 1)) / size,
          .freedom = kBlocks - 1};
}

constexpr std::int64_t kFewestFramePairs = 30;
constexpr std::size_t kFewestScattered = 4;

// Values with weights: their mean, with the larger of two errors: the one that their own errors
// make (its degrees of freedom are Welch's and Satterthwaite's), and that of the scatter of enough.
FittedValue weighted_mean(const std::vector<FittedValue>& values,
                          const std::vector<double>& weights) {
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  double mean = 0;
  for (std::size_t i = 0; i < values.size(); ++i) mean += weights[i] / all * values[i].value;
  double own = 0;
  double own_squares = 0;
  double scatter = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double share = std::pow(weights[i] / all * values[i].error, 2);
    own += share;
    own_squares += share * share / values[i].freedom;
    scatter += std::pow(weights[i] / all * (values[i].value - mean), 2);
  }
  const auto size = static_cast<double>(values.size());
  if (size > 1) scatter *= size / (size - 1);
  if (values.size() >= kFewestScattered && scatter > own)
    return {mean, std::sqrt(scatter), size - 1};
  return {mean, std::sqrt(own), own > 0 ? own * own / own_squares : kErrorBlocks - 1};
}

// The mean of the streams' correlations, weighted by their pairs, as that of a Gaussian copula.
std::optional<FittedValue> correlation_of(const std::vector<StreamFit>& streams) {
  std::vector<FittedValue> found;
  std::vector<double> weights;
  std::int64_t pairs = 0;
  for (const StreamFit& stream : streams) {
    if (std::isnan(stream.rank_correlation.value)) continue;
    found.push_back(stream.rank_correlation);
    weights.push_back(static_cast<double>(stream.pairs));
    pairs += stream.pairs;
  }
  if (pairs < kFewestFramePairs) return std::nullopt;
  const FittedValue spearman = weighted_mean(found, weights);
  const double per_rank = std::numbers::pi / 3 * std::cos(std::numbers::pi / 6 * spearman.value);
  return FittedValue{2 * std::sin(std::numbers::pi / 6 * spearman.value), per_rank * spearman.error,
                     spearman.freedom};
}

std::vector<std::optional<FittedValue>> skews_of(std::size_t cameras,
                                                 const std::vector<StreamFit>& streams) {
  std::vector<std::optional<FittedValue>> skews(cameras);
  for (const StreamFit& stream : streams) {
    std::optional<FittedValue>& best = skews[stream.camera];
    if (!best || stream.skew_ppm.error < best->error) best = stream.skew_ppm;
  }
  return skews;
}

void need_frames(const std::string& camera, const FitStream& stream) {
  if (stream.frames.size() >= kFewestFrames) return;
  throw FitError(fmt::format("camera {}, {}: found {}, a fit needs {} at least", camera,
                             stream.kind, counted(stream.frames.size(), "frame"), kFewestFrames));
}

void add_drops(const FitStream& stream, DropFit& drops, double& lost_together) {
  const FrameAccount& account = stream.account;
  drops.lost += account.lost;
  drops.counted += account.delivered + account.lost;
  lost_together += static_cast<double>(account.lost) * stream.lost_together;
}

// The interval of as many losses as are independent.
Interval drop_interval(const DropFit& drops, double lost_together) {
  const auto lost = static_cast<double>(drops.lost);
  const double together = drops.lost > 0 ? std::max(1.0, lost_together / lost) : 1;
  return binomial_interval(std::llround(lost / together),
                           std::llround(static_cast<double>(drops.counted) / together));
}

std::optional<DropFit> drops_of(const std::vector<FitStream>& streams) {
  std::optional<DropFit> drops;
  double lost_together = 0;
  for (const FitStream& stream : streams) {
    if (!stream.counted || stream.account.delivered == 0) continue;
    if (!drops) drops.emplace();
    add_drops(stream, *drops, lost_together);
  }
  if (drops) drops->interval = drop_interval(*drops, lost_together);
  return drops;
}

}  // namespace

Interval interval_of(const FittedValue& value) {
  constexpr double kTail = 0.025;
  const double half = student_t_exceeded(kTail, value.freedom) * value.error;
  return {.low = value.value - half, .high = value.value + half};
}

FittedValue successive_rank_correlation(const std::vector<double>& values,
                                        const std::vector<bool>& follows) {
  const std::vector<double> ranks = ranks_of(values);
  std::vector<double> before;
  std::vector<double> after;
  for (std::size_t i = 1; i < ranks.size(); ++i) {
    if (!follows[i]) continue;
    before.push_back(ranks[i - 1]);
    after.push_back(ranks[i]);
  }
  return correlation(std::move(before), std::move(after));
}

StreamFit fit_stream(const std::string& camera, const FitStream& stream) {
  need_frames(camera, stream);
  const std::vector<StampedFrame>& frames = stream.frames;
  const StampPoints points = stamp_points(frames);
  const RateLine line = rate_line(points.device_ms, points.distance_ms);
  StreamFit fit;
  fit.camera = stream.camera;
  fit.kind = stream.kind;
  fit.frames = static_cast<std::int64_t>(frames.size());
  fit.account = stream.account;
  fit.span_s = (points.device_ms.back() + points.distance_ms.back()) * 1e-3;
  const double error_ppm = line.error / std::pow(1 + line.slope, 2) * 1e6;
  fit.skew_ppm = {skew_of_slope_ppm(line.slope), error_ppm, line.freedom};
  if (is_doubtful_drift(fit.skew_ppm.value)) {
    throw FitError(
        fmt::format("camera {}, {}: found a drift of {:.0f} ppm, allowed that of a camera's clock, "
                    "some tens of ppm and 1 % at most; are both stamps milliseconds of one camera?",
                    camera, stream.kind, fit.skew_ppm.value));
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
  if (input.streams.empty()) throw FitError("the recording has no frames");
  const auto is_long = [](const FitStream& stream) {
    return stream.frames.size() >= kFewestFrames;
  };
  if (std::ranges::none_of(input.streams, is_long)) {
    const FitStream& first = input.streams.front();
    need_frames(input.cameras[first.camera].name, first);
  }
  RigFit fit;
  fit.left_out = input.left_out;
  for (const FitStream& stream : input.streams) {
    const std::string& camera = input.cameras[stream.camera].name;
    if (!is_long(stream)) {
      fit.left_out.push_back(fmt::format("camera {}, {}: all of it, {} where {} are needed", camera,
                                         stream.kind, counted(stream.frames.size(), "frame"),
                                         kFewestFrames));
      continue;
    }
    fit.streams.push_back(fit_stream(camera, stream));
    const StreamFit& added = fit.streams.back();
    for (const std::string& remark : stream_remarks(stream, added)) {
      fit.left_out.push_back(fmt::format("camera {}, {}: {}", camera, stream.kind, remark));
    }
    fit.has_delays = fit.has_delays || !has_one_clock(stream.frames);
    fit.frames += added.frames;
    fit.excess_ms.insert(fit.excess_ms.end(), added.excess_ms.begin(), added.excess_ms.end());
  }
  fit.skew_ppm = skews_of(input.cameras.size(), fit.streams);
  std::sort(fit.excess_ms.begin(), fit.excess_ms.end());
  fit.delivery_quantiles_ms = quantile_table(fit.excess_ms);
  fit.correlation = correlation_of(fit.streams);
  fit.drops = drops_of(input.streams);
  fit.network = fit_exchanges(input);
  return fit;
}

}  // namespace simbench::evaluation
