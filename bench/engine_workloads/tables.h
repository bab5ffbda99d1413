// The tables and random numbers of the engine workloads, common to every engine that runs them.
//
// Definitions and check values: docs/reference/event_engine.md section 1. All times in
// nanoseconds.
#ifndef SIMBENCH_BENCH_ENGINE_WORKLOADS_TABLES_H_
#define SIMBENCH_BENCH_ENGINE_WORKLOADS_TABLES_H_

#include <array>
#include <cstdint>

namespace simbench::bench {

struct WorkloadTables {
  std::array<std::int64_t, 4096> hold_ns;                  // E: delays of w1
  std::array<std::array<std::int64_t, 1024>, 5> stage_ns;  // J0..J4: delays of w2
};

// Made once, on first use.
const WorkloadTables& workload_tables();

// First expiry of a timer of w1.
std::int64_t first_expiry_ns(std::uint64_t timer);

// First trigger of a camera of w2.
std::int64_t trigger_phase_ns(std::uint64_t camera);

}  // namespace simbench::bench

#endif  // SIMBENCH_BENCH_ENGINE_WORKLOADS_TABLES_H_
