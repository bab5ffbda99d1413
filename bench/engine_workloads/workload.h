// The two workloads, run by simbench's engine and by the reference they are compared with.
//
// The reference uses no engine: a std::priority_queue of events in 16 bytes and a switch. It throws
// std::length_error beyond 3.4e10 events, which its keys cannot tell apart. Both sides share the
// models (models.h), so that only the queue and the dispatch differ. Definitions and checksums:
// docs/reference/event_engine.md section 1.
#pragma once

#include <cstdint>

namespace simbench::bench {

struct WorkloadResult {
  std::uint64_t events = 0;  // without the warm-up
  double seconds = 0;        // process CPU time of these events
  std::uint64_t checksum = 0;
  std::uint64_t order_checksum = 0;
};

// w1: `timers` timers expire `events` times after the warm-up. Both at least 1.
WorkloadResult run_hold(std::uint32_t timers, std::uint64_t events);
WorkloadResult run_hold_reference(std::uint32_t timers, std::uint64_t events);

// w2: at least 3 cameras for `duration_ms`. Throws std::invalid_argument if that is too short for
// the warm-up, six events per camera.
WorkloadResult run_rig(std::uint32_t cameras, std::int64_t duration_ms);
WorkloadResult run_rig_reference(std::uint32_t cameras, std::int64_t duration_ms);

// CPU time of this process in seconds.
double cpu_seconds();

// Throws the exception of run_rig and run_rig_reference.
[[noreturn]] void throw_too_short(std::int64_t duration_ms);

}  // namespace simbench::bench
