// Limits of clocks as data: masks of ITU-T, and limits of one's own. What a series says of them:
// evaluation/stability/mask_verdict.h.
//
//   mask      limits (ns, tau in s)
//   prtc_a    G.8272, PRTC-A: max|TE| 100, MTIE 25 + 0.275 tau to 273 and 100 to 10000, TDEV 3 to
//             100, 0.03 tau to 1000 and 30 to 10000 (clauses 6.1, 6.2, tables 1 and 3)
//   prtc_b    G.8272, PRTC-B: max|TE| 40, MTIE 25 + 0.275 tau to 54.5 and 40 to 10000, TDEV 1 to
//             100, 0.01 tau to 500 and 5 to 10000 (clauses 6.1, 6.2, tables 2 and 4)
//   class_a   G.8273.2, clause 7.1: max|TE| 100, cTE 50, dTE_L MTIE 40 and TDEV 4 from 1 to 1000,
//             dTE_H 70 peak to peak
//   class_b   the same with max|TE| 70, cTE 20
//   class_c   max|TE| 30, cTE 10, dTE_L MTIE 10 and TDEV 2 from 1 to 1000, dTE_H 30
//   class_d   max|TE_L| 5
//   sec       G.813 option 1, clause 7.1, wander at constant temperature: MTIE 40 to 1,
//             40 tau^0.1 to 100, 25.25 tau^0.2 to 1000, TDEV 3.2 to 25, 0.64 tau^0.5 to 100, 6.4
//             to 1000 (those of G.8262 option 1, tables 1 and 3)
//
// Where a range of tau begins is not said: at 0.1 s.
//
// How these compare with a measurement by the Recommendation: the quantities with an L or H are
// behind the filters of 0.1 Hz (evaluation/stability/band_filter.h), in points at most 2.5 s apart.
// The measurement filter of 10 Hz that G.8272 and G.813 want is not applied: it matters for points
// closer than 0.1 s. cTE is the mean of all points, where G.8273.2 averages over 1000 s; all its
// limits want a series of 1000 s. Its MTIE and TDEV are those at constant temperature, from 1 s on,
// as of a 1 PPS output. Limits are for a clock under the Recommendation's conditions against an
// ideal reference; a log of a program has its estimates.
//
// Where the figures are confirmed: those of G.8272 in allantools (mask.py, of the edition 11/18; it
// has no upper ends of tau, which here are 10000 s); those of G.8273.2 in Calnex's one-page summary
// (editions of 2017 and 10/20 with its amendments, of which the last has the 30 ns of dTE_H of
// class C); those of option 1 in timeTools (G.8262 of 07/2010) and, that G.813 has the same, in
// Calnex's summary of G.8262. Left out: what belongs to a variable temperature, relative errors,
// and of class D all but max|TE_L|, for which no such source has a figure.
//
// Errors: scenarios::InputError, "--mask: found ..., allowed: ..." and "--limit TEXT: ...".
//
//   const double largest_ms = limit_at(mask_named("prtc_a").limits[1], 64);   // MTIE
//   const ClockMask mine = limits_mask({"max_te=100ns", "mtie@10s=50ns", "adev@1s=1e-9"});
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evaluation/stability/band_filter.h"
#include "evaluation/stability/stability.h"

namespace simbench::evaluation {

enum class LimitedQuantity : std::uint8_t {
  kMaxTe,
  kConstantTe,  // its magnitude
  kPeakToPeak,
  kP50,
  kP95,
  kP99,
  kP999,
  kAdev,
  kMdev,
  kHdev,
  kTdev,
  kMtie
};

struct QuantityFacts {
  const char* id;      // in JSON: "max_te_ms", "adev"; it states the unit
  const char* option;  // in a limit of one's own
  const char* label;
  double TimeErrorSummary::*size;  // null: a deviation
  Deviation deviation;             // over tau
  bool has_tau() const { return size == nullptr; }
  bool is_time() const;  // in ms; else without a unit
};
const QuantityFacts& facts_of(LimitedQuantity quantity);

// From and to a tau: base + factor tau^exponent, in the unit of the quantity.
struct MaskSegment {
  double from_s = 0;
  double to_s = 0;  // the same: at this tau alone
  double base = 0;
  double factor = 0;
  double exponent = 0;
};

struct MaskLimit {
  std::string label{};  // "dTE_L MTIE"
  LimitedQuantity quantity = LimitedQuantity::kMaxTe;
  Band band = Band::kAll;
  std::vector<MaskSegment> segments{};  // of ascending tau without gaps; one where there is no tau
  double least_s = 0;                   // a shorter series cannot pass
};
// Within the segments; where two meet, that of the earlier one.
double limit_at(const MaskLimit& limit, double tau_s);

struct ClockMask {
  std::string id{};
  std::string title{};  // the Recommendation's name and class
  std::vector<MaskLimit> limits{};
};

// The masks of the list above; mask_named() throws for another name.
std::span<const ClockMask> masks();
const ClockMask& mask_named(const std::string& id);

// A mask of limits of one's own, each "NAME=VALUE" or "NAME@TAU=VALUE": max_te, cte, te_p2p, p50,
// p95, p99 and p99.9 with a time, mtie@ and tdev@ with a time, adev@, mdev@ and hdev@ with a
// number. Times have a unit: s, ms, us or ns. At least one limit.
ClockMask limits_mask(const std::vector<std::string>& limits);

}  // namespace simbench::evaluation
