// One axis of a sweep: which parameters of the scenario take which values, step by step.
//
//   /usb/delivery_jitter_transfers=0:0.4:0.1           a range, start:stop:step, stop included
//   /trigger/rate_hz=15,30,45                          a list: numbers, words, true, false
//   /hosts/count=2:6:2+/cameras/count=6:18:6           several in lockstep, where one alone
//                                                      would make no valid scenario
//
// Value i of a range is start + i * step, never a sum of steps, and where these are decimals the
// value is the decimal that a person expects: 0:1:0.1 has 0.3, not 0.30000000000000004. A value's
// text is the shortest that reads back as the same number.
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_AXIS_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_AXIS_H_

#include <cstddef>
#include <string>
#include <vector>

namespace simbench::evaluation {

struct SweepAxis {
  std::vector<std::string> pointers;             // JSON pointers; more than one: in lockstep
  std::vector<std::vector<std::string>> values;  // by pointer, then by step

  std::size_t steps() const { return values.front().size(); }
};

// More points than anybody waits for: a misplaced zero.
inline constexpr std::size_t kMostSteps = 100'000;

// Throws scenarios::InputError, "--sweep TEXT: found ..., allowed ...": no pointer, no value, an
// empty or endless range, a value twice, pointers in lockstep with different numbers of values.
SweepAxis parse_axis(const std::string& text);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_AXIS_H_
