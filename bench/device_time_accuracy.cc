// Accuracy of every registered device_time estimator in the worlds of device_time_worlds.h.
//
//   device_time_accuracy [runs]     a table of bias / std / worst in us after 60 s, 8 runs each
//
// Worlds: A, B (5 ppm sinusoid in the skew), D (a host step of +0.5 ms at 150 s), each with
// arrivals in whole microseconds; A and B again with arrivals in whole milliseconds, as
// librealsense's own are. Two-way estimators get polls and do not include the 8 ms of delivery: by
// this measure they are 8000 us early, which is subtracted here.
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "algorithms/registry.h"
#include "bench/device_time_worlds.h"

namespace simbench {
namespace {

bool uses_polls(const AlgorithmInfo& info) {
  return std::find(info.needs.begin(), info.needs.end(), Need::kPolls) != info.needs.end();
}

DeviceTimeErrors measured(const DeviceTimeEntry& entry, const std::vector<DeviceTimeRun>& runs) {
  const Nanoseconds latency =
      uses_polls(entry.info) ? from_ms(DeviceTimeWorld::kDelayMs) : from_ms(0);
  DeviceTimeErrors all;
  for (const DeviceTimeRun& run : runs) {
    const auto estimator = entry.make(check_parameters(entry.info.parameters, {}));
    std::vector<GlobalTime> stamps = device_time_stamps(*estimator, run);
    for (GlobalTime& stamp : stamps) stamp += latency;
    const DeviceTimeErrors errors = device_time_errors(run, stamps);
    all.bias_us += errors.bias_us / static_cast<double>(runs.size());
    all.std_us += errors.std_us / static_cast<double>(runs.size());
    all.worst_us = std::max(all.worst_us, errors.worst_us);
  }
  return all;
}

void print_table(std::uint32_t seeds) {
  struct Column {
    const char* title;
    DeviceTimeWorld world;
    std::vector<DeviceTimeRun> runs;
  };
  DeviceTimeWorld a;
  DeviceTimeWorld b;
  b.sinusoid_ppm = 5;
  DeviceTimeWorld d;
  d.host_step_ms = 0.5;
  DeviceTimeWorld a_1ms = a;
  a_1ms.arrival_quantum_ns = 1'000'000;
  DeviceTimeWorld b_1ms = b;
  b_1ms.arrival_quantum_ns = 1'000'000;
  std::vector<Column> columns = {{"A", a, {}},
                                 {"B: 5 ppm sinusoid", b, {}},
                                 {"D: step of 0.5 ms", d, {}},
                                 {"A, 1 ms arrivals", a_1ms, {}},
                                 {"B, 1 ms arrivals", b_1ms, {}}};
  fmt::print("us: bias / std / worst, t > 60 s, {} runs\n\n| {:22} |", seeds, "estimator");
  for (Column& column : columns) {
    fmt::print(" {:25} |", column.title);
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
      column.runs.push_back(make_device_time_run(column.world, seed));
    }
  }
  fmt::print("\n|{:-<24}|", "");
  for (std::size_t i = 0; i < columns.size(); ++i) fmt::print("{:-<27}|", "");
  fmt::print("\n");
  for (const DeviceTimeEntry& entry : algorithms<DeviceTimeEntry>()) {
    const std::string& family = entry.info.family;
    if (!entry.make || family == "eq1" || family == "sensor_normalised" ||
        family == "host_stamps" || family == "rocsync_led" || family == "coded_trigger") {
      continue;
    }
    fmt::print("| {:22} |", entry.info.name);
    for (const Column& column : columns) {
      const DeviceTimeErrors errors = measured(entry, column.runs);
      fmt::print(" {:7.1f} / {:6.1f} / {:7.1f} |", errors.bias_us, errors.std_us, errors.worst_us);
    }
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace simbench

int main(int argc, char** argv) {
  const long runs = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 8;
  if (argc > 2 || runs < 1 || runs > 1000) {
    fmt::print(stderr, "usage: device_time_accuracy [runs: 1 to 1000]\n");
    return 2;
  }
  simbench::print_table(static_cast<std::uint32_t>(runs));
  return 0;
}
