// Recordings of real rigs whose truth an instrument measured, as published figures, and the
// scenarios that predict them (scenarios/reality/*.json, whose schema documents every member; built
// into the program).
//
// A new recording is a new file in that folder, without any other change. Its scenarios take their
// parameters from documents alone; a figure that was known when a mechanism was chosen says so, and
// does not count.
//
//   simbench reality
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/choices.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {

// What is compared: quantiles of the time errors of a host in a run, against true time or, of a
// pair, against one host; or the residence of the master's messages to that host in the switch,
// from last bit to last bit.
enum class RealityQuantity : std::uint8_t {
  kMedianAbsTe,
  kP95AbsTe,
  kPairMedianAbsTe,
  kPairP95AbsTe,
  kPairSdTe,
  kResidenceMedian,
  kResidenceMax
};
constexpr auto words_of(RealityQuantity) {
  using enum RealityQuantity;
  return std::to_array<Word<RealityQuantity>>({{kMedianAbsTe, "median_abs_te"},
                                               {kP95AbsTe, "p95_abs_te"},
                                               {kPairMedianAbsTe, "pair_median_abs_te"},
                                               {kPairP95AbsTe, "pair_p95_abs_te"},
                                               {kPairSdTe, "pair_sd_te"},
                                               {kResidenceMedian, "residence_median"},
                                               {kResidenceMax, "residence_max"}});
}

// What loads hosts or network in a setting.
enum class RealityLoad : std::uint8_t { kNone, kTcp, kPaced, kRandom, kCpu, kDisk, kSteal };
constexpr auto words_of(RealityLoad) {
  using enum RealityLoad;
  return std::to_array<Word<RealityLoad>>({{kNone, "none"},
                                           {kTcp, "tcp"},
                                           {kPaced, "paced"},
                                           {kRandom, "random"},
                                           {kCpu, "cpu"},
                                           {kDisk, "disk"},
                                           {kSteal, "steal"}});
}

struct RealitySetting {
  std::string name;
  std::string scenario;
  std::vector<Override> set;
  std::string pipeline;
  std::size_t host = 1;
  RealityQuantity quantity = RealityQuantity::kMedianAbsTe;
  std::vector<double> measured_us;  // of each stretch or device
  double factor = 0;                // within which the prediction is to lie
  RealityLoad load = RealityLoad::kNone;
  // Predicted by measured, as `simbench reality` printed it when the file was written.
  double recorded_ratio = 0;
  std::string used_for;  // what was chosen knowing it; empty: it counts
};

// A parameter that the publication does not give.
struct UnknownParameter {
  std::string what;
  std::string pointer;
  std::string nominal;
  std::vector<std::string> values;  // JSON
  std::string source;
};

struct RealRecording {
  std::string name;
  std::string title;
  std::string source;
  std::string instrument;
  std::uint64_t duration_s = 0;
  std::uint64_t from_s = 0;
  std::uint64_t seeds = 0;
  std::size_t pairs_with = 0;  // the host that pairs are compared with
  std::vector<RealitySetting> settings;
  std::vector<UnknownParameter> unknown;
};

// In alphabetical order.
const std::vector<RealRecording>& real_recordings();

// How far the bench was off beside real rigs under each kind of load that the scenario has, a
// sentence each: "within a factor of 1.2 of real rigs under saturating TCP (chrony_chain; ...)", by
// the recorded ratios of hosts that are no more hops from their master than the scenario's are.
// None without load.
std::vector<std::string> load_reality(const Scenario& scenario);

}  // namespace simbench::scenarios
