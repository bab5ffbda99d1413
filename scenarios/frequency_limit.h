// How far an oscillator's random walk, and its ramp, take the frequency at most, as a fraction:
// further than any oscillator is off. A clock runs forward in every world; a run whose clocks get
// there says so, and so do the warnings of a scenario that makes it likely.
#pragma once

namespace simbench::scenarios {

inline constexpr double kMostFrequencyError = 0.05;

}  // namespace simbench::scenarios
