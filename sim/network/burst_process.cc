#include "sim/network/burst_process.h"

#include <algorithm>
#include <cmath>

namespace simbench::sim {
namespace {

constexpr double kDurationsPerCell = 20;

}  // namespace

BurstProcess::BurstProcess(const scenarios::Burst& parameters, std::uint64_t run_seed,
                           ComponentKey kind, std::uint64_t number)
    : run_seed_(run_seed),
      kind_(kind),
      number_(number),
      mean_gap_ms_(1e3 / parameters.rate_hz),
      mean_duration_ms_(parameters.duration_exponential_ms) {
  if (parameters.rate_hz == 0 || parameters.duration_exponential_ms == 0) return;
  cell_ns_ = std::max<std::int64_t>(1, from_ms(kDurationsPerCell * mean_duration_ms_).count());
  cell_ms_ = to_ms(Nanoseconds(cell_ns_));
}

bool BurstProcess::active(TrueTime t) {
  if (cell_ns_ == 0) return false;
  const std::int64_t since_zero_ns = t.time_since_epoch().count();
  const std::int64_t cell = since_zero_ns / cell_ns_ - (since_zero_ns % cell_ns_ < 0 ? 1 : 0);
  if (!is_sampled_ || cell != cell_) {
    is_sampled_ = true;
    cell_ = cell;
    bursts_.clear();
    sample_cell(cell - 1);
    sample_cell(cell);
  }
  return std::any_of(bursts_.begin(), bursts_.end(),
                     [t](const Interval& burst) { return burst.begin <= t && t < burst.end; });
}

void BurstProcess::sample_cell(std::int64_t cell) {
  RandomStream draw(run_seed_, kind_, number_, static_cast<std::uint64_t>(cell));
  for (double at_ms = draw.exponential(mean_gap_ms_); at_ms < cell_ms_;
       at_ms += draw.exponential(mean_gap_ms_)) {
    const TrueTime begin = TrueTime(Nanoseconds(cell * cell_ns_)) + from_ms(at_ms);
    const double duration_ms = std::min(draw.exponential(mean_duration_ms_), cell_ms_);
    bursts_.push_back({begin, begin + from_ms(duration_ms)});
  }
}

}  // namespace simbench::sim
