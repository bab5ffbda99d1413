// Numbers as people read them: a sensible number of digits, "-" for a value that does not exist.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "evaluation/scoring/results.h"
#include "recording/counted.h"

namespace simbench::reports {

// Three significant digits, whatever the size: "0", "0.00123", "12.3", "36000", "1.23e-05"; "-" for
// what is not finite, here and below.
std::string number_text(double value);

// With so many decimals: periods and rates, whose last digits are compared.
std::string decimals_text(double value, int decimals);

// A share in percent: "97.3 %". Only exactly 0 and 1 are written as 0 % and 100 %.
std::string share_text(double share);

// A percentile with its binomial interval: "33 % [18-51]".
std::string percentile_text(const evaluation::Percentile& percentile);

// "inside", "outside" or "too few seeds" of the published value at this percentile.
std::string placement_text(const evaluation::Percentile& percentile);
// What the three mean.
std::string placement_legend();

// A count with thousands set apart: "1 234 567".
std::string count_text(std::int64_t count);

// A large number in short: "950", "12.3 k", "4.56 M", "1.2 G".
std::string short_text(double value);

// The seeds of a result: "1 seed (7)", "32 seeds (1-32)".
std::string counted_seeds(std::uint64_t first, std::uint64_t count);

// The seeds behind the medians of a row: those that have a value in its metrics, of all.
struct ScoredSeeds {
  std::size_t all = 0;
  std::size_t fewest = 0;  // of a metric that has any
  std::size_t most = 0;

  // Adds a metric with so many.
  void add(std::size_t seeds);
  bool lack() const { return fewest < all; }
};

// "14 of 16"; "12-14 of 16" where the metrics differ.
std::string scored_seeds_text(const ScoredSeeds& seeds);
// The meaning of a column of these.
inline constexpr const char* kScoredSeedsLegend =
    "seeds: those with a value, of all; medians and bands are over them.";

// Why such a row has no AMD.
inline constexpr const char* kSingleCameraLegend =
    "AMD, RMDV, spreads and margin compare cameras: of a single one there are none.";

// "absolute error" as a title: "Absolute error".
std::string capitalised(std::string text);

}  // namespace simbench::reports
