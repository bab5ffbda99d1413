// Workload w1, hold: N timers, each rearmed when it expires. What the timers do, without an engine.
#ifndef SIMBENCH_BENCH_ENGINE_WORKLOADS_HOLD_MODEL_H_
#define SIMBENCH_BENCH_ENGINE_WORKLOADS_HOLD_MODEL_H_

#include <cstdint>

#include "bench/engine_workloads/tables.h"

namespace simbench::bench {

class HoldModel {
 public:
  // Timers expire `timers` times in all as warm-up, then `events` times.
  HoldModel(std::uint64_t timers, std::uint64_t events)
      : delays_ns_(workload_tables().hold_ns), warm_up_(timers), end_(timers + events) {}

  // One expiry. Returns the delay until the next one of the same timer.
  std::int64_t expire(std::uint32_t timer) {
    hash_ = hash_ * 0x9E3779B97F4A7C15 + timer;
    ++count_;
    return delays_ns_[next_delay_++ % delays_ns_.size()];
  }

  bool warmed_up() const { return count_ == warm_up_; }
  bool ended() const { return count_ == end_; }
  std::uint64_t checksum() const { return hash_; }

 private:
  const std::array<std::int64_t, 4096>& delays_ns_;
  std::uint64_t warm_up_;
  std::uint64_t end_;
  std::uint64_t count_ = 0;
  std::uint64_t hash_ = 0;
  std::uint64_t next_delay_ = 0;
};

}  // namespace simbench::bench

#endif  // SIMBENCH_BENCH_ENGINE_WORKLOADS_HOLD_MODEL_H_
