// Why the facts of a recording contradict each other: a chain of them that ends before it began.
//
// The chain is a cycle of negative length in the graph of the facts and of the clocks' own rates:
// following it, an instant would lie before itself. At least one of the assumptions behind its
// facts is wrong, or a stamp is. The chain found has no part that could be left out.
//
//   void show(const FactOrder& order, const CertifiedCapture& found) {
//     if (!found.contradiction) return;
//     const Contradiction proof = contradiction_of(order, *found.contradiction);
//     for (const std::uint32_t fact : proof.facts) use(order.facts()[fact].kind);
//   }
//
// Complexity: O(points) a pass, and as many passes as the chain changes its direction, some ten.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/certificates/rate_bound.h"
#include "evaluation/certificates/capture_evidence.h"
#include "evaluation/certificates/fact_order.h"

namespace simbench::evaluation {

struct Contradiction {
  std::vector<std::uint32_t> facts;  // in the order of the chain, places in FactOrder::facts()
  Picoseconds before{};              // by so much it would end before it began
};

// `closing`: the fact that a walk from the end of the recording was the first to refuse.
Contradiction contradiction_of(const FactOrder& order, std::uint32_t closing);

// Rates, in ppm, of all clocks, at which the evidence contradicts nothing: the least of 100, 200,
// 500 and 1000 that is above the assumed ones. Nothing if none is: then no rate explains it.
std::optional<double> possible_rate_ppm(const CaptureEvidence& evidence);

}  // namespace simbench::evaluation
