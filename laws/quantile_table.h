// A distribution as its quantiles at equally spaced probabilities, linear in between.
//
// A table of n numbers says: a share of i / (n - 1) of all values is at most table[i]. The last but
// one and the last number bound what is rarer than 1 / (n - 1); a table of 1001 numbers keeps the
// 99.9 % quantile and the maximum apart. value_at(u) of a uniform u is a draw from it.
//
// Contract: the table has 2 numbers at least, ascends, and outlives this. Units are the table's.
// Cost: a multiplication and an interpolation; no allocation.
//
//   const QuantileTable delay_ms(scenario.usb.delivery_quantiles_ms);
//   double ms = delay_ms.value_at(0.999);
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace simbench {

class QuantileTable {
 public:
  // No table: only empty() may be called.
  QuantileTable() = default;
  explicit QuantileTable(std::span<const double> table) : table_(table) {}

  bool empty() const { return table_.empty(); }
  double least() const { return table_.front(); }

  // `probability` in [0, 1].
  double value_at(double probability) const {
    const double place = probability * static_cast<double>(table_.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), table_.size() - 2);
    return table_[below] +
           (place - static_cast<double>(below)) * (table_[below + 1] - table_[below]);
  }

 private:
  std::span<const double> table_;
};

}  // namespace simbench
