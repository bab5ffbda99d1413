// The rates of all clocks against host 0's, as the recording shows them: of hosts by their
// messages, of cameras by the polls of their clocks.
//
// A line is fitted through the quicker half of the readings; the slower ones wait somewhere. It is
// an estimate, not a bound: a certificate that goes by it needs a margin that covers the error of
// the fit and the wander of the oscillators, and nothing in the recording proves one. Clocks with
// fewer than kFewestObserved readings, or less than a second of them, have none.
//
//   void show(const CaptureEvidence& evidence) {
//     for (const auto& ppm : observed_rates_ppm(evidence)) use(ppm);
//   }
//
// Complexity: O(readings * log(readings)). Source: laws/line_fit.h.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evaluation/certificates/capture_evidence.h"

namespace simbench::evaluation {

inline constexpr std::size_t kFewestObserved = 8;

// By clock, hosts first. 0 of host 0.
std::vector<std::optional<double>> observed_rates_ppm(const CaptureEvidence& evidence);

}  // namespace simbench::evaluation
