// The algorithms a scenario can name: simbench's own, and those that a user registers.
//
// A registered algorithm is a name, a line about it, its parameters and a factory. Pipelines name
// one algorithm per stage (of capture_alignment, none if they like); `simbench list algorithms`
// prints them all. An algorithm of your own, from your own repository, needs
// find_package(simbench), one registration and a call of run_command_line (cli/command_line.h):
//
//   simbench::register_device_time({
//       .info = {.name = "mine", .family = "mine", .summary = "...", .source = "...", ...},
//       .make = [](const simbench::Parameters& p) { return std::make_unique<Mine>(p); }});
//
// Parameters are looked up in the scenario under /algorithms/<family>/<parameter>.
// Registration is not thread-safe: do it while nothing runs. A name may be registered once per
// stage; a second registration throws std::invalid_argument. Where definitions come again, as from
// a cell of a notebook, replace_...() takes the place of one that was registered from outside.
#ifndef SIMBENCH_ALGORITHMS_REGISTRY_H_
#define SIMBENCH_ALGORITHMS_REGISTRY_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/device_time.h"
#include "algorithms/gathering/gathering.h"
#include "algorithms/parameters.h"
#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

// What an algorithm needs of the world beyond messages and clocks. A run in a world that lacks it
// is refused before it begins.
enum class Need : std::uint8_t {
  kHardwareStamps,  // Host::hardware_clock() and the stamps of the network card
  kPps,             // Host::pulse_input(PulseLine::kPps)
  kGnss,            // PulseStamp::gnss on that line
  kTriggerLine,     // Host::pulse_input(PulseLine::kTrigger)
  kFrames,          // Host::frame_feed()
  kFrameControl,    // Host::frame_controls()
  kPolls,           // polls of the cameras' clocks in the recording
  kHostStamps,      // cameras that stamp with their host's steady clock
  kLedClock,        // sightings of a clock of LEDs in the recording
  kTruth,           // the truth: simulation only
};

struct AlgorithmInfo {
  std::string name;
  std::string family;   // algorithms of one family share the scenario's parameters
  std::string summary;  // one line
  std::string source;
  std::vector<ParameterSpec> parameters{};
  std::vector<Need> needs{};
};

struct HostSyncEntry {
  AlgorithmInfo info;
  std::function<std::unique_ptr<HostSync>(const Parameters&)> make;
};
struct CaptureAlignmentEntry {
  AlgorithmInfo info;
  std::function<std::unique_ptr<CaptureAlignment>(const Parameters&)> make;
};
struct DeviceTimeEntry {
  AlgorithmInfo info;
  // Empty for "oracle", which needs the truth that only evaluation has.
  std::function<std::unique_ptr<DeviceTimeEstimator>(const Parameters&)> make;
};
struct GatheringEntry {
  AlgorithmInfo info;
  std::function<std::unique_ptr<Gatherer>(const Parameters&, const GatheringSetup&)> make;
};

void register_host_sync(HostSyncEntry entry);
void register_capture_alignment(CaptureAlignmentEntry entry);
void register_device_time(DeviceTimeEntry entry);
void register_gathering(GatheringEntry entry);

// The same, but in place of an entry of that name. Throws std::invalid_argument if it is one of
// simbench's own.
void replace_host_sync(HostSyncEntry entry);
void replace_capture_alignment(CaptureAlignmentEntry entry);
void replace_device_time(DeviceTimeEntry entry);
void replace_gathering(GatheringEntry entry);

// In order of registration, simbench's own first.
const std::vector<HostSyncEntry>& host_sync_algorithms();
const std::vector<CaptureAlignmentEntry>& capture_alignment_algorithms();
const std::vector<DeviceTimeEntry>& device_time_algorithms();
const std::vector<GatheringEntry>& gathering_algorithms();

// By name; null if there is none.
const HostSyncEntry* find_host_sync(const std::string& name);
const CaptureAlignmentEntry* find_capture_alignment(const std::string& name);
const DeviceTimeEntry* find_device_time(const std::string& name);
const GatheringEntry* find_gathering(const std::string& name);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_REGISTRY_H_
