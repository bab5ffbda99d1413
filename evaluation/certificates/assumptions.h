// What a certificate takes for granted. Everything else it derives; where one of these is wrong,
// the certificate may be wrong too, so they are printed with it.
//
// In a simulated world a draw from a normal law has no bound: stamps are taken to be within
// kSigmas of their jitter, and rates, of which a clock has one, within kRateSigmas of theirs and
// what temperature and wander add, or kDataSheet_ppm if that is more.
//
//   Assumptions assumed = assumptions_of(scenario);   // its granularities, jitters and rates
//   assumed.host_rate_ppm = 20;                       // these hosts have better quartzes
//   for (const AssumptionLine& line : described(assumed)) print(line.name, line.value);
//
// Units: in the names; the least delays hold from stamp to stamp.
// Source: docs/reference/d455.md section 1 (stamps), data sheets of quartz oscillators (50 ppm).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// All frames are exposed by pulses of one trigger, every so long.
struct CommonTrigger {
  double period_ms = 0;
  double rate_error_ppm = 100;
  double spread_ms = 0.1;  // of the exposures of one pulse: jitter, cables, the cameras' own delays
};

struct Assumptions {
  static constexpr double kSigmas = 8;
  static constexpr double kRateSigmas = 5;
  static constexpr double kDataSheet_ppm = 50;
  static constexpr double kMostRate_ppm = 1e5;  // no oscillator is that far off

  double host_rate_ppm = kDataSheet_ppm;    // of each host's oscillator, against true time
  double camera_rate_ppm = kDataSheet_ppm;  // of each camera's
  // The clocks' rates against host 0's are within this of what the recording shows
  // (observed_rates.h), in place of the two above where it shows them.
  std::optional<double> observed_margin_ppm{};
  double message_ms = 0;        // least delay of a message between hosts
  double poll_ms = 0;           // of either way of a poll of a camera's clock
  double arrival_ms = 0;        // from the end of an exposure until its frame has arrived
  double host_stamp_ms = 1e-6;  // a host's stamp is so far from what its clock read at most
  // And that of a stamp that is an estimate (Exchange::is_estimated); empty: such exchanges do not
  // count.
  std::optional<double> estimated_stamp_ms{};
  // How late a host sees a pulse of its PPS line, at most; empty: pulses do not count.
  std::optional<double> pulse_late_us{};
  double pulse_error_us = 0.1;             // a pulse is so far from the full second at most
  double arrival_stamp_ms = 1e-6;          // and below it, that of an arrival
  double sensor_stamp_us = 1;              // and that of a frame from the middle of its exposure
  std::optional<CommonTrigger> trigger{};  // empty: nothing is known of when cameras expose
};

Assumptions assumptions_of(const scenarios::Scenario& scenario);

struct AssumptionLine {
  std::string name;  // "host_rate_ppm"
  double value = 0;
  std::string means;  // "each host's oscillator is within +-50 ppm of true time"
};

std::vector<AssumptionLine> described(const Assumptions& assumptions);

}  // namespace simbench::evaluation
