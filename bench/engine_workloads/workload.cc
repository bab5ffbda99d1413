#include "bench/engine_workloads/workload.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <stdexcept>

#include "bench/engine_workloads/models.h"
#include "laws/generators.h"

namespace simbench::bench {
namespace {

constexpr double kHoldMean_ns = 4e8;

double open_uniform(SplitMix64& generator) {
  return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
}

std::int64_t exponential_ns(SplitMix64& generator, double mean_ns) {
  return static_cast<std::int64_t>(-std::log(open_uniform(generator)) * mean_ns);
}

WorkloadTables make_tables() {
  struct Stage {
    std::int64_t base_ns;
    double mean_ns;
  };
  constexpr std::array<Stage, 4> kStages = {
      {{3'000'000, 1e5}, {1'000'000, 2e5}, {1'000'000, 5e5}, {200'000, 1e5}}};

  WorkloadTables tables{};
  SplitMix64 generator(1);
  for (std::int64_t& delay : tables.hold_ns) delay = 1 + exponential_ns(generator, kHoldMean_ns);
  for (std::int64_t& delay : tables.stage_ns[0]) {
    delay = 2'000'000 + static_cast<std::int64_t>(open_uniform(generator) * 5e4);
  }
  for (std::size_t k = 0; k < kStages.size(); ++k) {
    for (std::int64_t& delay : tables.stage_ns[k + 1]) {
      delay = kStages[k].base_ns + exponential_ns(generator, kStages[k].mean_ns);
    }
  }
  return tables;
}

}  // namespace

const WorkloadTables& workload_tables() {
  static const WorkloadTables tables = make_tables();
  return tables;
}

std::int64_t first_expiry_ns(std::uint64_t timer) {
  SplitMix64 generator(1'000'003 + 7919 * timer);
  return 1 + exponential_ns(generator, kHoldMean_ns);
}

std::int64_t trigger_phase_ns(std::uint64_t camera) {
  SplitMix64 generator(77 + camera);
  return static_cast<std::int64_t>(open_uniform(generator) * 1e4);
}

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
