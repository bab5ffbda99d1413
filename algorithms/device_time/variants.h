// Variants of any device_time estimator, made by wrapping it, and their names.
//
//   <base>_steady               works on the host's steady clock, where no step or slew of the
//                               system clock can enter a fit; the host's log of adjustments maps
//                               its result to the system clock (clock_map.h)
//   <base>_exposure_corrected   subtracts half of each frame's exposure from its arrival first
//   <base>_calibrated           also subtracts delays that a user has measured once for this model
//                               and profile: from exposure's end to arrival, and of a poll's
//                               request minus that of its reply
//
//   <base>_sdk                  gets the arrivals that librealsense gives (TIME_OF_ARRIVAL): on the
//                               system clock, in whole milliseconds, rounded down
//
// Suffixes combine in any order; "calibrated" includes the exposure. "sdk" and "steady" exclude
// each other, as the SDK knows no steady clock. A wrapper passes everything else on: learn(),
// polls, adjustments, offline(), relative() and from_first_frame().
//
//   const DeviceTimeName name = parse_device_time_name("hull_300_steady_exposure_corrected");
//   auto estimator = make_variant(name,
//   find_algorithm<DeviceTimeEntry>(name.base)->make(parameters), {});
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "algorithms/device_time/device_time.h"

namespace simbench {

// The inner estimator gets steady times as arrivals and polls. Until the log of adjustments begins,
// the offset of the frame's own two arrivals maps its result to the system clock. The stamps of a
// relative() inner estimator are on no host's clock and stay as they are.
std::unique_ptr<DeviceTimeEstimator> on_steady_clock(std::unique_ptr<DeviceTimeEstimator> inner);

// Subtracts half of the exposure from the arrivals on both clocks: the remaining latency does not
// depend on the exposure if the camera stamps mid-exposure and delivers a fixed time after its end.
std::unique_ptr<DeviceTimeEstimator> exposure_corrected(std::unique_ptr<DeviceTimeEstimator> inner);

// The resolution of librealsense's time of arrival (docs/reference/d455.md section 1).
inline constexpr Nanoseconds kSdkResolution{1'000'000};

// Rounds the arrivals on the system clock down to kSdkResolution; polls stay as they are.
std::unique_ptr<DeviceTimeEstimator> on_sdk_stamps(std::unique_ptr<DeviceTimeEstimator> inner);

// Constants of a model and profile, never of one camera.
struct CalibratedDelays {
  Nanoseconds arrival{};         // from the end of an exposure to the frame's arrival
  Nanoseconds poll_asymmetry{};  // fixed delay of a poll's request minus that of its reply
};

// Also subtracts `delays.arrival`, and moves polls later by half of the asymmetry, so that the
// camera's reading lies in their middle.
std::unique_ptr<DeviceTimeEstimator> delay_corrected(std::unique_ptr<DeviceTimeEstimator> inner,
                                                     const CalibratedDelays& delays);

struct DeviceTimeName {
  std::string base;  // a registered name, if the whole name is valid
  bool steady = false;
  bool exposure_corrected = false;  // true if calibrated is
  bool calibrated = false;
  bool sdk = false;
  friend bool operator==(const DeviceTimeName&, const DeviceTimeName&) = default;
};

// Removes the suffixes from the end, each once: a second "_steady" stays in the base, which then is
// no registered name, and so does "_sdk" with "_steady".
DeviceTimeName parse_device_time_name(std::string_view name);

// `inner` with the variants of `name`; `delays` count only if it is calibrated.
std::unique_ptr<DeviceTimeEstimator> make_variant(const DeviceTimeName& name,
                                                  std::unique_ptr<DeviceTimeEstimator> inner,
                                                  const CalibratedDelays& delays);

}  // namespace simbench
