// An error divided among what causes it, by Shapley values over the worlds in which some of the
// causes are taken away.
//
// A player's part is the reduction of the error when its cause is taken away, averaged over all
// orders in which the causes can be. The parts and the remainder (what is left without all of them)
// add up to the error of each seed, but for rounding, and so do their means. A part may be
// negative: two errors can cancel.
//
// Source: Shapley, "A value for n-person games", 1953.
//
//   const std::vector<double> own = shapley_values(std::vector<double>{3, 1, 2, 0});  // {2, 1}
#pragma once

#include <span>
#include <vector>

namespace simbench::evaluation {

// Returns the Shapley values of n players: by how much each lowers the worth. `worth[s]` belongs to
// the coalition whose members are the bits of s, 2^n values in all. O(n 2^n).
std::vector<double> shapley_values(std::span<const double> worth);

// The mean over the seeds, which unlike a median adds up, with the band from 5 to 95 %.
struct BudgetPart {
  std::vector<double> values;  // by seed
  double mean = 0;
  double p05 = 0;
  double p95 = 0;
};

struct DividedError {
  BudgetPart total;
  std::vector<BudgetPart> players;
  BudgetPart remainder;
};

// `by_world[s]` has the error of each seed where the causes that are the bits of s are taken away.
DividedError divide_error(const std::vector<std::vector<double>>& by_world);

// The values of the seeds with their mean and band.
BudgetPart budget_part(std::vector<double> values);

}  // namespace simbench::evaluation
