#include "evaluation/clock_run/program_duration.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <variant>

#include "evaluation/clock_run/clock_score.h"

namespace simbench::evaluation {
namespace {

using scenarios::Pipeline;
using scenarios::Scenario;

constexpr double kLeastS = 600;
constexpr double kLeastAffordedS = 360;
constexpr double kBeyondS = 300;
constexpr double kLeastMeasuredS = 60;

double end_of_last_fault_s(const Scenario& scenario) {
  double end_ms = 0;
  for (const scenarios::Fault& fault : scenario.faults) {
    std::visit(
        [&end_ms](const auto& each) {
          if constexpr (requires { each.at_ms; }) {
            double lasts_ms = 0;
            if constexpr (requires { each.duration_ms; }) lasts_ms = each.duration_ms;
            end_ms = std::max(end_ms, each.at_ms + lasts_ms);
          }
        },
        fault);
  }
  return 1e-3 * end_ms;
}

}  // namespace

std::vector<const Pipeline*> program_pipelines(const Scenario& scenario,
                                               const std::vector<std::string>& names) {
  std::vector<const Pipeline*> found;
  for (const Pipeline& pipeline : scenario.pipelines) {
    const bool is_chosen = names.empty() || std::ranges::count(names, pipeline.name) > 0;
    if (is_chosen && pipeline.programs) found.push_back(&pipeline);
  }
  return found;
}

std::uint64_t program_duration_s(const Scenario& scenario, const std::vector<std::string>& names,
                                 std::uint64_t from_s) {
  const auto from = static_cast<double>(from_s);
  double wanted_s = std::max({kLeastS, end_of_last_fault_s(scenario) + kBeyondS, from + kBeyondS});
  double processes = 0;
  for (const Pipeline* pipeline : program_pipelines(scenario, names)) {
    wanted_s = std::max(wanted_s, pipeline->programs->run_before_capture_s + kBeyondS);
    processes += static_cast<double>(pipeline->programs->master.size()) +
                 static_cast<double>(scenario.hosts.count - 1) *
                     static_cast<double>(pipeline->programs->slave.size());
  }
  const double most_s = std::max(
      {kLeastAffordedS, kMostProcessSeconds / std::max(1.0, processes), from + kLeastMeasuredS});
  constexpr double kMinute = 60;
  return static_cast<std::uint64_t>(kMinute * std::ceil(std::min(wanted_s, most_s) / kMinute));
}

bool loss_is_worth_it(std::uint64_t duration_s) {
  return std::chrono::seconds(duration_s) >= kMasterLostFor + kRecovery;
}

}  // namespace simbench::evaluation
