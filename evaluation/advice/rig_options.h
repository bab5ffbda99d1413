// The rigs that a buyer can put together: hosts, USB cards, switch and clock source for so many
// cameras at such a rate, from parts (scenarios/part.h), each with its price and its scenario.
//
// The world is that of the camera (scenarios/part.h), physically nominal and fitted to nothing,
// with the cameras, hosts and rate of the request, and what the parts set. Cameras are divided
// among the hosts, the last ones may have fewer. A host takes the cheapest choice of host and USB
// cards that carries its cameras; a single host needs neither switch nor clock source. A choice is
// left out where it is dearer and no better: a switch whose extra is of no use to the clock source,
// USB cards beyond need.
//
// A camera that is a host (GigE, OAK, a Raspberry Pi) needs no USB, and brings its own host
// synchronisation; its exposures are steered and not triggered. There is one computer besides where
// it needs one, the cheapest.
//
// The rate decides the sync mode of a triggered camera: genlock where the camera has a mode of
// twice the rate (which it halves), else slave in a mode of the rate itself, with a trigger that
// runs 500 ppm fast as slaves need it (docs/reference/d455.md). Any other rate is refused.
//
//   const RigRequest rig = {.cameras = 24, .rate_hz = 60};
//   const std::vector<RigOption> options = rig_options(rig);
//   const scenarios::Scenario world = scenario_of(options.front(), rig, scenario.pipelines);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/part.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

inline constexpr const char* kUsualCamera = "d455";
inline constexpr std::int64_t kMostAdviceCameras = 1000;

struct RigRequest {
  std::string camera = kUsualCamera;  // a part
  std::int64_t cameras = 1;
  double rate_hz = 30;
  std::int64_t fewest_hosts = 1;
  std::int64_t most_hosts = 8;
  std::vector<scenarios::Part> more_parts{};  // of the user
  std::vector<scenarios::Override> sets{};    // of the world, last
};

struct RigOption {
  scenarios::Part camera{};
  std::int64_t hosts = 1;
  std::int64_t cameras_per_host = 1;  // of the fullest
  scenarios::Part host{};             // if there are computers besides the cameras
  scenarios::Part usb_card{};         // if there are cards
  std::int64_t cards_per_host = 0;    // of the fullest
  std::int64_t cards = 0;             // in all
  scenarios::Part network_switch{};   // if there are several hosts
  scenarios::Part clock{};            // likewise
  scenarios::PriceRange price{};      // without cameras and trigger

  // "8 x office_pc, office_switch, software".
  std::string name() const;
  // The host synchronisations to choose from.
  std::vector<std::string> host_sync() const;
};

// Returns the part that RigRequest::camera names, of the user's or simbench's own. Throws
// scenarios::InputError if there is none.
scenarios::Part camera_of(const RigRequest& request);

// The cheapest first. Throws scenarios::InputError if there is none.
std::vector<RigOption> rig_options(const RigRequest& request);

// Throws scenarios::InputError for what no such world supports, a rate without a mode above all.
scenarios::Scenario scenario_of(const RigOption& option, const RigRequest& request,
                                const std::vector<scenarios::Pipeline>& pipelines);

// The rates that the camera, a part, has a mode for, ascending.
std::vector<double> supported_rates_hz(const std::string& camera);

}  // namespace simbench::evaluation
