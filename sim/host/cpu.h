// The one CPU of a host: whatever costs time is served one after the other, in order of asking.
//
//   const Cpu::Turn turn = cpu.reserve(from_ms(4.5));
//   co_await sleep_until(context, turn.end, "host3: set clock");
#ifndef SIMBENCH_SIM_HOST_CPU_H_
#define SIMBENCH_SIM_HOST_CPU_H_

#include <algorithm>

#include "recording/true_time.h"
#include "sim/engine/engine.h"

namespace simbench::sim {

class Cpu {
 public:
  struct Turn {
    TrueTime start;
    TrueTime end;
  };

  explicit Cpu(const Engine& engine) : engine_(engine) {}

  // The next `cost` of CPU time that is free.
  Turn reserve(Nanoseconds cost) {
    const TrueTime start = std::max(engine_.now(), free_at_);
    free_at_ = start + cost;
    return {start, free_at_};
  }

 private:
  const Engine& engine_;
  TrueTime free_at_ = TrueTime::min();
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_CPU_H_
