// The algorithms a scenario can name: simbench's own, and those that a user registers.
//
// A registered algorithm is a name, a line about it, its parameters and a factory. Pipelines name
// one algorithm per stage (ports/stage.h); `simbench list algorithms` prints them all. An algorithm
// of your own, from your own repository, needs find_package(simbench), one registration and a call
// of run_command_line (cli/command_line.h):
//
//   register_algorithm(with_settings<DeviceTimeEntry>(
//       {.name = "mine", .family = "mine", .summary = "...", .source = "..."}, MySettings{},
//       kMake<Mine>));
//
// Its settings state the parameters (parameter_binder.h), which are looked up in the scenario under
// /algorithms/<family>/<parameter>.
// Registration is not thread-safe: do it while nothing runs. A name may be registered once per
// stage; a second registration throws std::invalid_argument. Where definitions come again, as from
// a cell of a notebook, replace_algorithm() takes the place of one that was registered from
// outside.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/device_time/device_time.h"
#include "algorithms/gathering/gathering.h"
#include "algorithms/parameter_binder.h"
#include "algorithms/parameters.h"
#include "algorithms/ports/stage.h"

namespace simbench {

class CaptureAlignment;  // algorithms/ports/capture_alignment.h
class HostSync;          // algorithms/ports/host_sync.h

// What an algorithm needs of the world beyond messages and clocks. A run in a world that lacks it
// is refused before it begins.
enum class Need : std::uint8_t {
  kHardwareStamps,  // Host::hardware_clock() and the stamps of the network card
  kPps,             // Host::pulse_input(PulseLine::kPps)
  kGnss,            // PulseStamp::gnss on that line
  kTriggerLine,     // Host::pulse_input(PulseLine::kTrigger)
  kTsf,             // RadioClock::read_tsf()
  kFtm,             // RadioClock::measure_ftm()
  kFrames,          // Host::frame_feed()
  kFrameControl,    // Host::frame_controls()
  kPolls,           // polls of the cameras' clocks in the recording
  kHostStamps,      // cameras that stamp with their host's steady clock
  kLedClock,        // sightings of a clock of LEDs in the recording
  kTriggerCode,     // GatheringSetup::pulses, DeviceTimeEstimator::on_coded_pulses()
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
  static constexpr PipelineStage kStage = PipelineStage::kHostSync;
  AlgorithmInfo info;
  std::function<std::unique_ptr<HostSync>(const Parameters&)> make;
};
struct CaptureAlignmentEntry {
  static constexpr PipelineStage kStage = PipelineStage::kCaptureAlignment;
  AlgorithmInfo info;
  std::function<std::unique_ptr<CaptureAlignment>(const Parameters&)> make;
};
struct DeviceTimeEntry {
  static constexpr PipelineStage kStage = PipelineStage::kDeviceTime;
  AlgorithmInfo info;
  // Empty for "oracle", which needs the truth that only evaluation has.
  std::function<std::unique_ptr<DeviceTimeEstimator>(const Parameters&)> make;
};
struct GatheringEntry {
  static constexpr PipelineStage kStage = PipelineStage::kGathering;
  AlgorithmInfo info;
  std::function<std::unique_ptr<Gatherer>(const Parameters&, const GatheringSetup&)> make;
};

// An entry of an algorithm whose parameters its settings state: make(settings), of gathering
// make(settings, setup), gets those of a run. `defaults` are those of this entry.
template <class Entry, class Settings, class Make>
Entry with_settings(AlgorithmInfo info, const Settings& defaults, Make make) {
  info.parameters = specs_of(defaults);
  return {.info = std::move(info),
          .make = [defaults, make](const Parameters& parameters, const auto&... setup) {
            return make(settings_from(parameters, defaults), setup...);
          }};
}

// For a class that is constructed from its settings.
template <class Algorithm>
inline constexpr auto kMake =
    [](const auto& settings) { return std::make_unique<Algorithm>(settings); };

// Entry is the stage's: HostSyncEntry, CaptureAlignmentEntry, DeviceTimeEntry or GatheringEntry.
template <class Entry>
void register_algorithm(Entry entry);

// The same, but in place of an entry of that name. Throws std::invalid_argument if it is one of
// simbench's own.
template <class Entry>
void replace_algorithm(Entry entry);

// In order of registration, simbench's own first.
template <class Entry>
const std::vector<Entry>& algorithms();

// By name; null if there is none.
template <class Entry>
const Entry* find_algorithm(const std::string& name);

// A stage that is known at run time has its algorithms here, in the same order; find_algorithm()
// returns null if there is none of that name.
std::vector<const AlgorithmInfo*> algorithms_of(PipelineStage stage);
const AlgorithmInfo* find_algorithm(PipelineStage stage, const std::string& name);
// Lists simbench's own algorithms, without those that were registered from outside.
std::vector<const AlgorithmInfo*> own_algorithms_of(PipelineStage stage);

}  // namespace simbench
