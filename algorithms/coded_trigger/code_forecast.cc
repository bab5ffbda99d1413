#include "algorithms/coded_trigger/code_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "laws/median.h"
#include "laws/normal_law.h"

namespace simbench {
namespace {

// At half of the distance, sqrt(RSS), of two places: exp(-RSS / (2 noise^2)) is the likelihood.
double union_bound(CodeCorrelator& correlator, const CodeVerdict& verdict, double noise_us) {
  double bound = 0;
  for (std::size_t place = 0; place < correlator.places(); ++place) {
    if (place == verdict.place) continue;
    const double behind = correlator.nats_behind(verdict, place, noise_us);
    bound += normal_probability(-std::sqrt(std::max(0.0, behind) / 2));
  }
  return bound;
}

}  // namespace

CodeForecast forecast_of(const std::shared_ptr<const CodedPulses>& pulses,
                         const CodeDecoderSettings& settings) {
  const TriggerCode& code = pulses->code;
  CodeForecast forecast;
  forecast.places = std::min(code.length(), CodeForecast::kPlaces);
  CodeSearch search(pulses, settings);
  std::vector<double> frames;
  for (std::int64_t i = 0; i < forecast.places; ++i) {
    const std::int64_t begin = i * code.length() / forecast.places;
    search.clear();
    // A search that begins anew would take another place for its first.
    for (std::int64_t pulse = begin; search.held() < CodeSearch::kMostHeld; ++pulse) {
      if (!code.is_sent(pulse)) continue;
      const Nanoseconds at = pulse * code.period() + code.shift(pulse);
      const CodeSearch::Outcome outcome = search.add(at.count());
      if (outcome.given_up > 0) break;
      if (!outcome.is_found) continue;
      ++forecast.found;
      frames.push_back(static_cast<double>(search.held()));
      const std::int64_t first = pulse - search.slot(search.held() - 1);
      if (code.place(first) != search.verdict().place) ++forecast.wrong;
      forecast.pulses_worst =
          std::max(forecast.pulses_worst, static_cast<double>(pulse - begin + 1));
      forecast.error_probability =
          std::max(forecast.error_probability, search.verdict().error_probability);
      forecast.union_bound =
          std::max(forecast.union_bound,
                   union_bound(search.correlator(), search.verdict(), settings.noise.noise_us));
      break;
    }
  }
  if (code.leaves_out()) forecast.union_bound = std::numeric_limits<double>::quiet_NaN();
  if (frames.empty()) return forecast;
  forecast.frames_worst = std::ranges::max(frames);
  forecast.frames_median = median_in_place(frames);
  return forecast;
}

}  // namespace simbench
