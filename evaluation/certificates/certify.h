// Certificates: for each gathered set, the intervals that surely hold how far its frames were
// exposed from each other.
//
// An estimate says what is likely; two frames a whole period apart may have stamps that agree, if
// the clocks behind them are wrong together. A certificate says what is possible: it follows from
// the assumptions (assumptions.h) and the recording's messages, polls and arrivals by exact
// arithmetic, and no method could give a smaller interval from them (clock_graph.h). If the facts
// contradict each other, an assumption is wrong: then there is no certificate, and the facts that
// prove it are named (contradiction.h).
//
// All of the recording counts, what came later too: each set is looked at from a cut behind it,
// from both sides (frontier.h). With kCausal only what came before the cut does, as for a
// program that certifies while it runs.
//
//   void show(const CaptureEvidence& evidence, std::span<const EvidenceSet> sets) {
//     const FactOrder order(evidence);
//     const CertifiedCapture found = certify(evidence, order, sets, Horizon::kWhole);
//     for (const SetCertificate& set : found.sets) use(to_ms(set.apart));
//   }
//
// Complexity: O(points * clocks) and O(sets * clocks^3). Memory: the evidence, 40 bytes a point,
// and 8 * clocks^2 bytes for some 2 * sqrt(sets) sets. Source: Patt-Shamir and Rajsbaum, STOC 1994.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/certificates/clock_graph.h"
#include "evaluation/certificates/capture_evidence.h"
#include "evaluation/certificates/fact_order.h"

namespace simbench::evaluation {

enum class Horizon : std::uint8_t { kWhole, kCausal };

// The frames of a set, by their places in CaptureEvidence::frames().
using EvidenceSet = std::vector<std::size_t>;

// The ties that a difference of two frames hangs on: each camera's to its host, and the hosts'.
enum class LinkKind : std::uint8_t { kCamera, kHosts };

struct WeakLink {
  LinkKind kind = LinkKind::kCamera;
  std::uint32_t first = 0;   // the camera, or a host
  std::uint32_t second = 0;  // the other host
  Picoseconds width{};       // of the interval of the difference
};

// One pair of a set: surely least <= second frame - first frame <= most.
struct PairInterval {
  std::size_t first = 0;  // places in the set
  std::size_t second = 0;
  Picoseconds least{};
  Picoseconds most{};
};

struct SetCertificate {
  Picoseconds apart{};    // no two frames of it are further apart; ClockGraph::kUnbounded: unknown
  PairInterval widest{};  // the pair that may be so far apart
  WeakLink weakest{};     // of that pair; without a meaning for a set of one frame
  std::optional<Nanoseconds> truth_apart{};  // of the widest pair; simulated captures only
  // Frames whose true difference to another is known and bounded, so that it can be outside; and
  // those of a pair whose interval does not hold it.
  std::size_t frames_judged = 0;
  std::size_t frames_outside = 0;
};

struct CertifiedCapture {
  std::vector<SetCertificate> sets;            // as given
  std::optional<std::uint32_t> contradiction;  // the fact that closes it, in the FactOrder
  std::size_t impossible_sets = 0;             // a pair of which no pulses of the trigger explain
};

// Called with each pair of each set, in order.
using PairVisitor = std::function<void(std::size_t set, const PairInterval&)>;

// Throws NotCertifiable (fact_order.h).
CertifiedCapture certify(const CaptureEvidence& evidence, const FactOrder& order,
                         std::span<const EvidenceSet> sets, Horizon horizon,
                         const PairVisitor& visit = {});

// What is left of an interval where both frames were exposed by pulses of one trigger: the hull of
// its parts within `spread_ms` of a whole number of periods. Nothing if none is left.
std::optional<PairInterval> narrowed(const PairInterval& interval, const CommonTrigger& trigger);

}  // namespace simbench::evaluation
