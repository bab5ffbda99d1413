// What the error of the hosts' clocks comes from: how much of it is the world's and how much the
// host synchronisation's own.
//
// An algorithm does not report what it estimates, so each part is a counterfactual: the same
// algorithm runs with the same seeds in worlds of which some causes are taken away. There are
// three:
//
//   messages     the network and the hosts pass each message in a constant time that is the same in
//                both directions, lose none and stamp it exactly; so do network cards and pulse
//                lines; no load, no burst, no host or link that stops. The part is called
//                estimation: what the algorithm makes of imperfect measurements.
//   oscillators  the oscillators of hosts and cards are perfect from the beginning, and no fault
//                steps a clock; the first offsets stay. The part is called staleness: what the
//                clocks have drifted since they were last corrected, and drift that was mistaken
//                for offset.
//   clock calls  a clock is read and set exactly and at once: no ticks, no resolution, no cost. The
//                part is called steering. An algorithm's own limits, such as its largest rate, stay
//                in the remainder.
//
// A part is a Shapley value (shapley.h) over the 2^3 worlds, divided is the host clock error
// (host_error_ms, docs/design.md section 8). The remainder is the error without all three: the
// algorithm's own, from convergence that has not ended, a correction it does not make, a wrong
// model (a one-way method does not know even a constant latency), its rounding.
//
// Not divided, but given a note: a host_sync that sends nothing (the limits), one that looks at
// frames, whose way over USB is no message's, one host, and programs that cannot run here. A real
// program is divided like an algorithm. A seed that has no error in one of the worlds is NaN in all
// parts.
//
// Cameras and trigger stay real. The latency that stays is the scenario's fixed one, or the least
// of its table. Streams of random numbers belong to components, so what is real draws the same.
//
// Cost: 8 captures per seed and host_sync; the stages behind it are replaced by cheap ones.
//
//   const std::vector<HostClockBudget> budgets =
//       host_clock_budgets(scenario, scenario.pipelines, make_world, {.seeds = 32}, nullptr);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/budget/shapley.h"
#include "evaluation/run/evaluate.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

enum class HostClockCause : std::uint8_t { kMessages, kOscillators, kClockCalls };

inline constexpr std::size_t kHostClockCauseCount = 3;
inline constexpr std::size_t kHostClockWorlds = std::size_t{1} << kHostClockCauseCount;

// What a cause's part is called, and the cause, as the schema of scenarios names it (x-stage).
struct HostClockPart {
  std::string_view name;
  std::string_view cause;
};
inline constexpr std::array<HostClockPart, kHostClockCauseCount> kHostClockParts = {{
    {"estimation", "messages"},
    {"staleness", "oscillators"},
    {"steering", "clock calls"},
}};

struct HostClockBudget {
  std::string pipeline;
  std::string note{};  // why some or all seeds are not divided, one line; else empty
  bool is_divided = false;
  BudgetPart total{};
  std::array<BudgetPart, kHostClockCauseCount> parts{};
  BudgetPart algorithm{};  // the remainder
};

// Returns the scenario without the causes that are the bits of `ideal`.
scenarios::Scenario without_causes(const scenarios::Scenario& scenario, std::size_t ideal);

// Returns a budget for each pipeline, in this order. Ignores EvaluationOptions::pipelines and
// keep_pulses. Throws what evaluate() throws. Progress counts runs: 8 for each seed and divided
// pipeline; it is not called where there are none.
std::vector<HostClockBudget> host_clock_budgets(const scenarios::Scenario& scenario,
                                                const std::vector<scenarios::Pipeline>& pipelines,
                                                const WorldFactory& make_world,
                                                const EvaluationOptions& options,
                                                const Progress& progress);

}  // namespace simbench::evaluation
