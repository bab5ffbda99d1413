// Small made archives for the tests of comparisons, baselines and gates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "reports/archive/archive.h"

namespace simbench::reports {

inline constexpr const char* kSampleScenario =
    R"({"name": "sample", "summary": "for tests", "timeline": {"frames": 60},
        "network": {"latency_fixed_ms": 0.1}, "evaluation": {"table": "pipelines"},
        "algorithms": {"yoon2021": {"stamps": 100}},
        "pipelines": [{"name": "plain", "host_sync": "ntp"}, {"name": "good", "host_sync": "ptp"}]})";

// AMD of a seed: between 0.5 and 1.5 times `level`, the same for the same seed.
inline double sample_amd(std::uint64_t seed, double level) {
  return level * (0.5 + static_cast<double>((seed * 37) % 101) / 100);
}

inline evaluation::Row sample_row(const std::string& name, std::uint64_t first, std::uint64_t count,
                                  double level) {
  std::vector<double> amd;
  std::vector<double> rmdv;
  std::vector<double> error;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    amd.push_back(sample_amd(seed, level));
    rmdv.push_back(sample_amd(seed, level) / 3);
    error.push_back(sample_amd(seed + 5, level));
  }
  evaluation::Row row;
  row.pipeline = name;
  row.amd_ms = evaluation::make_series(amd);
  row.rmdv_ms = evaluation::make_series(rmdv);
  row.absolute_error_ms = evaluation::make_series(error);
  row.seed_recall = evaluation::make_series(std::vector<double>(count, 1.0));
  return row;
}

// Pipelines "plain" (AMD about 10 ms) and "good" (about 2 ms).
inline Archive sample_archive(const std::string& path, std::uint64_t first = 1,
                              std::uint64_t count = 32) {
  Archive archive;
  archive.path = path;
  archive.version = "1.2.3";
  archive.commit = "abc";
  archive.command = {"/usr/bin/simbench", "run", "--scenario", "my sample.json"};
  archive.scenario_json = kSampleScenario;
  archive.results.scenario = "sample";
  archive.results.first_seed = first;
  archive.results.seed_count = count;
  archive.results.rows = {sample_row("plain", first, count, 10),
                          sample_row("good", first, count, 2)};
  return archive;
}

// All values of a series times a factor.
inline void scale(evaluation::Series& series, double factor) {
  for (double& value : series.values) value *= factor;
  series = evaluation::make_series(series.values);
}

}  // namespace simbench::reports
