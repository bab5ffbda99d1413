// How soon a camera finds its place in a trigger's code, and how surely: before there is a camera.
//
// From each of kPlaces evenly spaced places of the code (all of a shorter one), the search is given
// frames without noise and without losses until it takes a place. With noise as it is stated the
// same takes a frame or two more or fewer; each lost frame takes one more.
//
// The union bound is of the places that a search takes then: over all other places, the sum of the
// probabilities that noise as stated makes that other place look better, each of a normal law, at
// half of the distance between the two. It has nothing of Bayes, and is another check of the
// probability that the search itself states. There is none for codes that leave pulses out.
//
// Complexity: O(kPlaces * frames * length). Source: docs/coded_trigger.md section 4.
//
//   const CodeForecast forecast = forecast_of(pulses, settings);
//   const double seconds = forecast.frames_worst * to_seconds(pulses->code.period());
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "algorithms/coded_trigger/code_search.h"

namespace simbench {

struct CodeForecast {
  static constexpr std::int64_t kPlaces = 256;

  std::int64_t places = 0;  // that were tried
  std::int64_t found = 0;   // of them, within the frames that a search holds
  std::int64_t wrong = 0;   // of these
  double frames_median = 0;
  double frames_worst = 0;
  double pulses_worst = 0;       // in which these came, those left out too
  double union_bound = 0;        // the largest of any place; NaN where pulses are left out
  double error_probability = 0;  // likewise, as the search states it
};

CodeForecast forecast_of(const std::shared_ptr<const CodedPulses>& pulses,
                         const CodeDecoderSettings& settings);

}  // namespace simbench
