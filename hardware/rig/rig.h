// A rig: which hosts there are and how to reach them, which cameras they have, what triggers them.
//
// The loaded form of a rig file (JSON, checked against hardware/rig/schema.json, which is built
// into the program). The same file is used on every host and by the command that conducts the rig;
// the order of hosts is their number in recordings, host 0 is the master. Cameras are numbered in
// the order of the file, host by host.
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
// "recording" makes a camera the vendor-free one that plays a recording in real time: a folder that
// `simbench record` wrote, or a CSV (recording/rs_csv.h); "recorded_camera" says which of its
// cameras (default: the first of that name or 0), "trigger_file" when it starts
// (camera/recorded_camera.h). Paths are relative to the rig file. "trigger": "manual" asks the user
// at a prompt; it may be left out where no scenario needs one.
//
// Errors: scenarios::InputError, "FILE:LINE: /pointer: found ..., allowed ...": no JSON, unknown or
// missing members, a host name or serial twice, a host without name or address, an address that is
// no address while there is no key ("127.0.0.1" and "::1" are allowed without).
#ifndef SIMBENCH_HARDWARE_RIG_RIG_H_
#define SIMBENCH_HARDWARE_RIG_RIG_H_

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
  bool manual = false;     // a prompt
  std::string on_command;  // run by the shell of the machine that conducts the rig
  std::string off_command;
  friend bool operator==(const RigTrigger&, const RigTrigger&) = default;
};

struct Rig {
  std::string name;
  std::string file;  // as the user named it, for messages
  std::vector<RigHost> hosts;
  std::optional<RigTrigger> trigger;

  std::size_t cameras() const;
  // All addresses are this machine's own loopback.
  bool loopback_only() const;
};

Rig load_rig(const std::string& path);
// The same from text, as if it were the content of `path`; the fuzz target's way in.
Rig load_rig_text(const std::string& text, const std::string& path);

// The number of the host of this name. Throws InputError that lists those there are.
PeerId host_named(const Rig& rig, const std::string& name);

// What must agree before anything is started: as many hosts as the scenario has, and on each as
// many cameras; a trigger where the scenario's sync mode needs one. Throws InputError.
void check_rig_fits(const Rig& rig, const scenarios::Scenario& scenario);
// The JSON schema of rig files, hardware/rig/schema.json, which is built into the program.
std::string_view rig_schema_text();

// Without a key all addresses must be loopback. Throws InputError.
void check_rig_is_guarded(const Rig& rig, bool has_key);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_RIG_RIG_H_
