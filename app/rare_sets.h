// How often a pipeline's sets go wrong in a simulated world, down to once in a million and less: a
// world's runs for importance splitting (evaluation/rare/splitting.h).
//
// A run is a rig (its clocks, cables, calibrations) with its loads: jitter and jumps of deliveries,
// messages, polls, bursts. All of them are streams that sim/engine/seed_field.h can change. Its
// level is the largest spread of an evaluated pulse, the range of its global stamps. Two events are
// asked for:
//
//  - kSpread: the spread of a pulse is above a bound. The share of a run is that of its pulses.
//  - kWrongSet: a complete set that gathering emitted has members of different pulses. The share is
//    that of its complete sets. It is looked for above a bound of a quarter of the period: frames
//    of two pulses are a period apart and gathering joins what is within half of one, so two
//    cameras of a wrong set err by half a period against each other; that no pulse of such a run
//    has a spread of half of that is taken for granted.
//
// A probability is thus that of a set of a rig drawn at random, over rigs and time together: a
// certain rig is better or worse. Evaluated pulses lie in the capture of the scenario; what happens
// once a day, and the drift of days, is not in it.
//
// Every draw can be moved by itself (sim/engine/seed_field.h). Some hundred of them decide an event
// of a host that is synchronised by messages: one in a hundred drawn anew loses more than half of
// the events, so that chains forget slowly. evaluation/rare/splitting.h has what that costs.
//
// The whole world runs each time, with the service's hours before the capture: they are most of the
// cost, and a shorter service or capture would be another law.
//
//   const evaluation::RareFunction run =
//       rare_sets(scenario, "chrony_lan", RareEvent::kSpread, 0.1);
//   const auto estimate = evaluation::estimate_rare(run, {.bound = 0.1}, nullptr);
#pragma once

#include <cstdint>
#include <string>

#include "evaluation/rare/splitting.h"
#include "scenarios/scenario.h"

namespace simbench::app {

enum class RareEvent : std::uint8_t { kSpread, kWrongSet };

// The level above which wrong sets are looked for.
double wrong_set_bound_ms(const scenarios::Scenario& scenario);

// `scenario` must outlive the result. Throws scenarios::InputError for an unknown pipeline. A run
// without an evaluated pulse is no event.
evaluation::RareFunction rare_sets(const scenarios::Scenario& scenario, const std::string& pipeline,
                                   RareEvent event, double bound_ms);

}  // namespace simbench::app
