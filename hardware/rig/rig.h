// A rig: its hosts and their addresses, their cameras, and its trigger.
//
// The loaded form of a rig file (JSON, checked against hardware/rig/schema.json, which is built
// into the program). Every host and the conducting command use the same file. Hosts have the
// numbers of their order, also in recordings; host 0 is the master. Cameras are numbered in the
// order of the file, host by host.
//
//   {
//     "schema_version": 1,
//     "name": "studio",
//     "hosts": [
//       {"name": "host0", "address": "10.0.0.10", "port": 47110,
//        "cameras": [{"serial": "018322071234"},
//                    {"serial": "demo", "recording": "left.csv"}]},
//       ...],
//     "trigger": {"on_command": "trigger on", "off_command": "trigger off"}
//   }
//
// A camera with a "recording" plays it in real time: a folder that `simbench record` wrote, or a
// CSV (recording/rs_csv.h). "recorded_camera" names one of its cameras (default: the one of this
// serial, or the first), "trigger_file" starts it (camera/recorded_camera.h). Paths are relative to
// the rig file. "trigger": "manual" asks the user at a prompt; without a trigger in the file, only
// scenarios that need none can run.
//
// Errors: scenarios::InputError, "FILE:LINE: /pointer: found ..., allowed ...": no JSON, unknown or
// missing members, a repeated host name or serial, an impossible name or address.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "scenarios/loader.h"

namespace simbench::hardware {

inline constexpr std::uint16_t kDefaultPort = 47110;

struct RigCamera {
  std::string serial;
  std::string recording{};        // empty: a real camera
  std::string recorded_camera{};  // empty: the one of this serial, or the first
  std::string trigger_file{};     // empty: plays from its start
  friend bool operator==(const RigCamera&, const RigCamera&) = default;
};

struct RigHost {
  std::string name;
  std::string address;
  std::uint16_t port = kDefaultPort;
  std::vector<RigCamera> cameras;
  friend bool operator==(const RigHost&, const RigHost&) = default;
};

struct RigTrigger {
  bool manual = false;     // by a prompt
  std::string on_command;  // run by the shell of the machine that conducts the rig
  std::string off_command;
  friend bool operator==(const RigTrigger&, const RigTrigger&) = default;
};

struct Rig {
  std::string name;
  std::string file;  // as the user named it, for messages
  std::vector<RigHost> hosts;
  std::optional<RigTrigger> trigger;
};

Rig load_rig(const std::string& path);
// Reads text as if it were the content of `path`.
Rig load_rig_text(const std::string& text, const std::string& path);

// The number of the host of this name. Throws InputError, which lists the known names.
PeerId host_named(const Rig& rig, const std::string& name);

// Throws InputError unless the rig has as many hosts as the scenario, on each as many cameras, and
// a trigger if the scenario's sync mode needs one.
void check_rig_fits(const Rig& rig, const scenarios::Scenario& scenario);
// The JSON schema of rig files, hardware/rig/schema.json, which is built into the program.
std::string_view rig_schema_text();

// Without a key all addresses must be loopback. Throws InputError.
void check_rig_is_guarded(const Rig& rig, bool has_key);

}  // namespace simbench::hardware
