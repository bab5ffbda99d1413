// Durations as people read them: in the unit that fits, with three significant digits.
//
//   time_text(0.0031);             // "3.10 us"
//   time_band_text(0.35, 1.2);     // "[0.350, 1.20] ms"
#pragma once

#include <string>

namespace simbench::reports {

// A unit of time, and the smallest size that is shown in it.
struct ShownUnit {
  double from_ms = 0;
  double per_ms = 0;
  const char* name = nullptr;
};

// The unit for a column whose largest entry this is.
const ShownUnit& time_unit_of(double ms);

// "35.0 ns", "3.12 us", "0.694 ms", "543 ms", "1.61 s"; "0" for 0, "-" for what is not finite.
std::string time_text(double ms);

// A round duration at a tick, without zeros: "10 us".
std::string tick_text(double ms);

// Both ends in the unit of the one further from zero: "[0.350, 1.20] ms"; "-" if one is not finite.
std::string time_band_text(double low_ms, double high_ms);

// Both in the unit of the larger, "from 2.92 to 1.89 ms", unless they are more than a factor of
// 1000 apart: "from 50.0 ms to 0.280 us"; "-" if one is not finite.
std::string time_change_text(double from_ms, double to_ms);

}  // namespace simbench::reports
