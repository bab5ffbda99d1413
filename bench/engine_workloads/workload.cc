#include "bench/engine_workloads/workload.h"

#include <fmt/format.h>

#include <ctime>
#include <stdexcept>

namespace simbench::bench {

double cpu_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void throw_too_short(std::int64_t duration_ms) {
  throw std::invalid_argument(
      fmt::format("{} ms end within the warm-up of six events per camera", duration_ms));
}

}  // namespace simbench::bench
