// A scenario: one world to synchronise and the pipelines to try in it, as plain data.
//
// This is the loaded form of a scenario file (scenarios/*.json), after inheritance ("base"), --set
// overrides, schema validation and semantic checks; load it with scenarios/loader.h. The structs of
// its sections are made from scenarios/schema.json when simbench is built, which states each member
// once: its name, unit, meaning, allowed range, source and default. They stand, with the meaning of
// every member, in build/<preset>/generated/scenarios/schema_structs.h. A scenario inherits or
// states every member without a default, so that `simbench describe` prints every number behind a
// result; the zeros of a struct that nobody loaded never reach a world. Members whose values are
// words are enums (scenarios/choices.h).
//
// Conventions: *_sigma is a standard deviation of a zero-mean normal; *_exponential_ms the mean of
// an exponential; *_log_sigma the sigma of exp(N(0, sigma)), a factor of median 1; a probability is
// per message, per frame or per pulse. "Run load" M = exp(N(load_log_sigma)) is drawn once per
// (seed, pipeline, scenario). Faults happen during the capture: their times count from its start,
// and a duration lasts until the camera, host or link returns.
//
// Sources: docs/reference/calibration.md (sections 1 and 2), docs/reference/d455.md, docs/design.md
// section 7.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenarios/choices.h"
#include "scenarios/derivation.h"
#include "scenarios/lazy.h"
#include "scenarios/schema_structs.h"

namespace simbench::scenarios {

inline double Trigger::period_ms() const { return 1e3 / rate_hz; }
inline double Trigger::pulse_rate_hz() const { return rate_hz * (1 + rate_error_ppm * 1e-6); }
inline double Stream::image_bytes() const {
  return static_cast<double>(width * height) * bytes_per_pixel;
}
inline bool ClockPoll::is_on() const { return interval_ms > 0; }
inline bool AutoExposure::is_on() const { return step_interval_exponential_ms > 0; }

// The host that this one follows; 0, the master, of the master itself.
std::uint32_t followed_host(const Hosts& hosts, std::uint32_t host);

// The last part of the path: "chronyd".
std::string program_name(const HostPrograms::Command& command);

// One choice for each stage, by the names under which algorithms are registered. Programs take the
// place of an algorithm; host_sync is then "program" and the name of the slaves' first one.
struct Pipeline {
  std::string name;
  std::string host_sync;
  std::string device_time;
  std::string gathering;
  std::optional<HostPrograms> programs{};
  std::string capture_alignment{};  // empty: none
};

// A parameter of an algorithm, which the algorithm's registration checks.
using ParameterValue = std::variant<bool, double, std::string>;
// Parameters by algorithm (its name or its family's), then by parameter name.
using AlgorithmParameters = std::map<std::string, std::map<std::string, ParameterValue>>;

// Where each JSON pointer of the scenario came from, for messages (scenarios/loader.h).
class Origin;

struct Scenario {
  std::string name;
  std::string summary;
  Timeline timeline;
  Hosts hosts;
  Network network;
  Trigger trigger;
  Cameras cameras;
  Usb usb;
  std::vector<Fault> faults;
  Evaluation evaluation;
  AlgorithmParameters algorithms;
  std::vector<Pipeline> pipelines;
  std::map<std::string, Published> published;  // by pipeline name
  std::vector<PublishedFigure> published_figures;
  std::vector<std::string> fitted_to;  // paths of a recording; mostly none
  std::optional<Studio> studio;        // only of scenarios that have one
  Derivation derivation;               // from a built-in scenario
  Lazy<std::string> resolved_json;     // fully resolved, pretty-printed
  std::shared_ptr<const Origin> origin;

  // The host that camera j is plugged into.
  std::int64_t host_of(std::int64_t camera) const {
    return cameras.host_of_camera.empty()
               ? camera / cameras.cameras_per_host
               : cameras.host_of_camera[static_cast<std::size_t>(camera)];
  }
  // How many cameras each host has.
  std::vector<std::size_t> cameras_by_host() const;
  // Whether each pipeline draws a load of its own, which its sends, messages and settings of clocks
  // meet (sim/network/load.h).
  static constexpr std::array kLoadMembers = {"/hosts/send_cost_session_exponential_ms",
                                              "/network/latency_session_exponential_ms",
                                              "/hosts/clock/set_cost_session_log_sigma"};
  bool draws_load() const {
    return hosts.send_cost_session_exponential_ms > 0 ||
           network.latency_session_exponential_ms > 0 || hosts.clock.set_cost_session_log_sigma > 0;
  }
  // The scored stream; a loaded scenario has it.
  const Stream* scored_stream() const { return cameras.stream(evaluation.stream); }
  // The highest rate of pulses of which a stream that follows the trigger answers each: it ignores
  // pulses for two mode periods in genlock, for one as a slave, less the guard.
  double fastest_pulses_hz(const Stream& stream) const;
  // A stream answers one of so many pulses, if its exposures leave it the time: 1 mostly, and of a
  // stream that does not follow the trigger.
  std::int64_t pulses_per_frame(const Stream& stream) const;
  // As many as its program passes on, for those that follow the trigger (/hosts/frame_reader).
  std::int64_t pulses_per_passed_frame(const Stream& stream) const;
  // The rate at which a stream delivers frames if none is lost.
  double frame_rate_hz(const Stream& stream) const;
};

}  // namespace simbench::scenarios
