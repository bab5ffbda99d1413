// The delays of a machine's network stack as a study: laws that a scenario can state.
//
// A part's law is what `/hosts/stack/*` of a scenario takes (scenarios/schema.json): quantiles at
// kStackQuantiles equally spaced probabilities from 0 to 1, and rare spikes on top. The longest
// kSpikeShare of the delays are the spikes, the quantiles are those of the rest, so that one long
// delay does not stretch the whole end of the table. A spike is uniform, an assumption, with the
// measured mean.
//
//   write_stack_study("network_stack.json", {.date = "2021-09-14", .machine = "a desktop",
//       .conditions = {{.name = "idle", .busy_threads = 0, .parts = {{"transmit", law}}}}});
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace simbench::reports {

inline constexpr std::size_t kStackQuantiles = 33;
inline constexpr double kSpikeShare = 0.005;

struct StackLaw {
  std::size_t messages = 0;
  std::vector<double> quantiles_us;
  double spike_probability = 0;
  double spike_max_us = 0;
  double mean_us = 0;     // of all delays
  double longest_us = 0;  // of all delays
  // Spearman's correlation of a delay with the next message's: 0 for independent delays.
  double correlation_with_next = 0;
};

// `delays_us`: in the order of the messages, at least kStackQuantiles of them.
StackLaw stack_law(const std::vector<double>& delays_us);

struct StackPart {
  std::string name;  // "transmit", "passage", "wake_up"
  StackLaw law;
};

struct StackCondition {
  std::string name;  // "idle", "beside_load"
  unsigned busy_threads = 0;
  std::vector<StackPart> parts;
};

struct StackStudy {
  std::string date;
  std::string machine;
  std::vector<StackCondition> conditions;
};

// With this program's commit.
std::string stack_study_json(const StackStudy& study);
void write_stack_study(const std::string& path, const StackStudy& study);

}  // namespace simbench::reports
