#include "bench/engine_workloads/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <vector>

#include "bench/engine_workloads/workload.h"

namespace simbench::bench {
namespace {

struct Case {
  const char* workload;
  std::uint32_t size;
  std::int64_t length;  // events of w1, ms of w2: long enough for some tens of milliseconds
  double target_ratio;
};

constexpr std::array<Case, 6> kCases = {{{"w1", 24, 2'000'000, 1.1},
                                         {"w1", 1000, 2'000'000, 0.9},
                                         {"w1", 100'000, 1'000'000, 0.8},
                                         {"w2", 18, 300'000, 0.75},
                                         {"w2", 1800, 3'000, 0.55},
                                         {"w2", 18'000, 400, 0.5}}};

WorkloadResult run_simbench(const Case& c) {
  return c.workload[1] == '1' ? run_hold(c.size, static_cast<std::uint64_t>(c.length))
                              : run_rig(c.size, c.length);
}

WorkloadResult run_reference(const Case& c) {
  return c.workload[1] == '1' ? run_hold_reference(c.size, static_cast<std::uint64_t>(c.length))
                              : run_rig_reference(c.size, c.length);
}

double ns_per_event(const WorkloadResult& result) {
  return 1e9 * result.seconds / static_cast<double>(result.events);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string compare_case(const Case& c, int pairs) {
  std::vector<double> own_ns;
  std::vector<double> reference_ns;
  std::vector<double> ratios;
  for (int pair = 0; pair < pairs; ++pair) {
    WorkloadResult own;
    WorkloadResult reference;
    if (pair % 2 == 0) reference = run_reference(c);
    own = run_simbench(c);
    if (pair % 2 == 1) reference = run_reference(c);
    if (own.checksum != reference.checksum || own.order_checksum != reference.order_checksum) {
      throw std::runtime_error(fmt::format("{} {}: the checksums differ", c.workload, c.size));
    }
    own_ns.push_back(ns_per_event(own));
    reference_ns.push_back(ns_per_event(reference));
    ratios.push_back(own_ns.back() / reference_ns.back());
  }
  return fmt::format("{:<10} {:>12.2f} {:>13.2f} {:>7.3f} {:>7.2f}\n",
                     fmt::format("{} {}", c.workload, c.size), median(own_ns), median(reference_ns),
                     median(ratios), c.target_ratio);
}

}  // namespace

std::string compare_with_reference(int pairs) {
  std::string table = fmt::format("{:<10} {:>12} {:>13} {:>7} {:>7}\n", "case", "simbench ns",
                                  "reference ns", "ratio", "target");
  for (const Case& c : kCases) table += compare_case(c, pairs);
  return table;
}

}  // namespace simbench::bench
