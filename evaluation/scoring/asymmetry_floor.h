// The least error of every host synchronisation that measures over unequal links.
//
// Two-way stamps cannot separate an offset from half the difference of the two directions' delays.
// If each slave's link is asymmetric by N(0, sigma), each slave's clock is off by N(0, sigma / 2),
// at best; the master's is right. Means over seeds, of
//
//   host clock error  E|X|,                      X = N(0, sigma / 2)
//   AMD               E range of {0, X_1 ... X_n} = 2 Int_0^inf (1 - Phi(x)^n) dx * sigma / 2
//
// for n slaves. Algorithms that do not measure over the links (common view, GNSS) may be below.
// Source: docs/reference/host_sync.md section 3.
//
//   asymmetry_floor(/*sigma_ms=*/0.01, /*hosts=*/6)->amd_ms;   // 0.0117
#pragma once

#include <cstdint>
#include <optional>

namespace simbench::evaluation {

struct AsymmetryFloor {
  double sigma_ms = 0;  // forward minus backward delay of a link
  double host_error_ms = 0;
  double amd_ms = 0;
};

// Nothing without slaves or without asymmetry.
std::optional<AsymmetryFloor> asymmetry_floor(double sigma_ms, std::int64_t hosts);

}  // namespace simbench::evaluation
