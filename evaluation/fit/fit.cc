#include "evaluation/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kFewestPairs = 30;

// The streams' own correlations, each by the number of its pairs.
std::optional<FittedValue> correlation_of(const std::vector<StreamFit>& streams) {
  double sum = 0;
  std::int64_t pairs = 0;
  for (const StreamFit& stream : streams) {
    if (std::isnan(stream.rank_correlation)) continue;
    sum += stream.rank_correlation * static_cast<double>(stream.pairs);
    pairs += stream.pairs;
  }
  if (pairs < kFewestPairs) return std::nullopt;
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

double RigFit::drop_share() const {
  return static_cast<double>(missing) / static_cast<double>(frames + missing);
}

std::vector<double> quantile_table(const std::vector<double>& sorted) {
  const std::size_t size = std::min(kLongestTable, sorted.size());
  std::vector<double> table;
  for (std::size_t i = 0; i < size; ++i) {
    const double place = static_cast<double>(i) / static_cast<double>(size - 1) *
                         static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    table.push_back(sorted[below] +
                    (place - static_cast<double>(below)) * (sorted[above] - sorted[below]));
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
    fit.missing += added.missing;
    fit.excess_ms.insert(fit.excess_ms.end(), added.excess_ms.begin(), added.excess_ms.end());
  }
  fit.skew_ppm = skews_of(input, fit.streams);
  std::sort(fit.excess_ms.begin(), fit.excess_ms.end());
  fit.delivery_quantiles_ms = quantile_table(fit.excess_ms);
  fit.correlation = correlation_of(fit.streams);
  fit.drop_interval = binomial_interval(fit.missing, fit.frames + fit.missing);
  fit.network = fit_exchanges(input);
  return fit;
}

}  // namespace simbench::evaluation
