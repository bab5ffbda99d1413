#include "app/experiment_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "algorithms/device_time/clock_map.h"
#include "app/own_program.h"
#include "hardware/conductor/rig_source.h"
#include "hardware/experiment/network_sandbox.h"
#include "hardware/relay/network_law.h"
#include "recording/recording_folder.h"
#include "sim/rig/simulation.h"

namespace simbench::app {
namespace {

constexpr const char* kPlayed = "played";

std::vector<hardware::NodeOscillator> oscillators_of(const hardware::RigSource& source) {
  std::vector<hardware::NodeOscillator> oscillators;
  for (const hardware::HostReport& host : source.hosts()) {
    if (host.lost) throw RecordingFailed(host.name + " was lost");
    oscillators.push_back(host.oscillator);
  }
  return oscillators;
}

using FrameName = std::tuple<std::uint32_t, StreamKind, std::uint32_t>;

FrameName name_of(const FrameRecord& frame) { return {frame.camera, frame.stream, frame.counter}; }

// The capture that was played; its times count from the recording's zero.
class Played {
 public:
  explicit Played(const KeptRecording& recording) {
    std::optional<TrueTime> zero;
    for (const KeptEvent& event : recording.events()) {
      const auto* frame = event_as<FrameEvent>(event);
      if (frame == nullptr || !frame->truth) continue;
      frames_.emplace(name_of(frame->record), *frame->truth);
      if (frame->truth->pulse < 0) continue;
      zero = std::min(zero.value_or(frame->truth->exposure_start), frame->truth->exposure_start);
    }
    if (!zero) throw RecordingFailed("the played capture has no frame that a pulse exposed");
    zero_ = *zero;
    for (const KeptEvent& event : recording.events()) {
      if (const auto* pulse = event_as<PulseTruth>(event)) pulses_.push_back(*pulse);
    }
    std::stable_sort(pulses_.begin(), pulses_.end(),
                     [](const PulseTruth& a, const PulseTruth& b) { return a.at < b.at; });
  }

  const FrameTruth& find(const FrameRecord& frame) const {
    const auto found = frames_.find(name_of(frame));
    if (found == frames_.end()) {
      throw RecordingFailed(
          fmt::format("camera {}: frame {} was never played", frame.camera, frame.counter));
    }
    return found->second;
  }
  const std::vector<PulseTruth>& pulses() const { return pulses_; }  // in order of time
  Nanoseconds since_zero(TrueTime at) const { return at - zero_; }

 private:
  std::map<FrameName, FrameTruth> frames_;
  std::vector<PulseTruth> pulses_;
  TrueTime zero_;
};

// The readings of each host's clocks at an instant.
class Clocks {
 public:
  Clocks(std::vector<hardware::NodeOscillator> oscillators, const KeptRecording& captured)
      : oscillators_(std::move(oscillators)), maps_(oscillators_.size()) {
    for (const KeptEvent& event : captured.events()) {
      const auto* adjustment = event_as<ClockAdjustment>(event);
      if (adjustment != nullptr && adjustment->host < maps_.size()) {
        maps_[adjustment->host].add(*adjustment);
      }
    }
    for (std::size_t host = 0; host < maps_.size(); ++host) {
      if (maps_[host].segments() == 0) {
        throw RecordingFailed(fmt::format("host {} left no log of its clock", host));
      }
    }
  }

  std::size_t hosts() const { return maps_.size(); }
  SteadyTime steady(std::size_t host, MonotonicTime at) const {
    return oscillators_[host].steady(at);
  }
  HostTime system(std::size_t host, MonotonicTime at) const {
    return maps_[host].to_system(steady(host, at)).value();
  }
  MonotonicTime when(std::size_t host, SteadyTime at) const { return oscillators_[host].when(at); }

 private:
  std::vector<hardware::NodeOscillator> oscillators_;
  std::vector<ClockMap> maps_;
};

class TruthAdder {
 public:
  TruthAdder(const ExperimentTruth& truth, const KeptRecording& captured, RecordingSink& sink)
      : played_(truth.played),
        zero_(truth.zero),
        layout_(truth.played.layout()),
        clocks_(truth.oscillators, captured),
        sink_(sink) {
    if (clocks_.hosts() != layout_.hosts) {
      throw RecordingFailed(
          fmt::format("{} hosts answered, {} were played to", clocks_.hosts(), layout_.hosts));
    }
  }

  void hand_over(const KeptRecording& captured) {
    sink_.on_start(layout_);
    for (const KeptEvent& event : captured.events()) {
      if (const auto* frame = event_as<FrameEvent>(event)) {
        add_frame(frame->record);
      } else {
        notify(event, sink_);
      }
    }
    add_pulses(MonotonicTime::max());
  }

 private:
  MonotonicTime instant(TrueTime played) const { return zero_ + played_.since_zero(played); }
  static TrueTime as_true(MonotonicTime at) { return TrueTime(at.time_since_epoch()); }

  void add_frame(const FrameRecord& frame) {
    const std::uint32_t host = layout_.cameras.at(frame.camera).host;
    const MonotonicTime arrived = clocks_.when(host, frame.arrival_steady);
    add_pulses(arrived);
    FrameTruth truth = played_.find(frame);
    const MonotonicTime middle = instant(truth.mid_exposure());
    truth.exposure_start = as_true(instant(truth.exposure_start));
    truth.exposure_end = as_true(instant(truth.exposure_end));
    truth.reference = clocks_.system(0, middle);
    truth.own_host = clocks_.system(host, middle);
    truth.own_steady = clocks_.steady(host, middle);
    truth.delivered = clocks_.system(0, arrived);
    sink_.on_frame(frame, &truth);
  }

  // Hands over the pulses up to this instant.
  void add_pulses(MonotonicTime until) {
    for (; added_ < played_.pulses().size(); ++added_) {
      const PulseTruth& pulse = played_.pulses()[added_];
      const MonotonicTime at = instant(pulse.at);
      if (at > until) return;
      const HostTime master = clocks_.system(0, at);
      PulseTruth measured = {.pulse = pulse.pulse, .at = as_true(at)};
      for (std::size_t host = 0; host < clocks_.hosts(); ++host) {
        measured.host_errors.push_back(clocks_.system(host, at) - master);
      }
      sink_.on_event(measured);
    }
  }

  Played played_;
  MonotonicTime zero_;
  const RigLayout& layout_;
  Clocks clocks_;
  RecordingSink& sink_;
  std::size_t added_ = 0;
};

bool runs_programs(const scenarios::Scenario& scenario, const std::string& pipeline) {
  return std::any_of(scenario.pipelines.begin(), scenario.pipelines.end(),
                     [&](const scenarios::Pipeline& each) {
                       return each.name == pipeline && each.programs.has_value();
                     });
}

}  // namespace

ExperimentSource::ExperimentSource(const scenarios::Scenario& scenario, ExperimentOptions options)
    : scenario_(scenario), options_(std::move(options)) {
  hardware::check_relay_can(scenario);
}

std::string ExperimentSource::program_log(std::uint64_t seed) const {
  if (options_.program_log.empty()) return "";
  return fmt::format("{}/measured_seed{}", std::filesystem::absolute(options_.program_log).string(),
                     seed);
}

std::string ExperimentSource::record_cameras(std::uint64_t seed) {
  const std::string folder = folder_.file(fmt::format("seed{}", seed));
  const RecordingRequest request = {.seed = seed, .pipeline = kPlayed};
  sim::make_simulation(scenario_)->record(request, played_);
  if (!std::filesystem::exists(folder)) {
    RecordingWriter writer(folder, {.backend = "sim", .scenario_json = scenario_.resolved_json()});
    played_.play(writer.begin(kPlayed, seed));
    writer.end({});
  }
  return fmt::format("{}#{}/{}", folder, kPlayed, seed);
}

RecordingCost ExperimentSource::record(const RecordingRequest& request, RecordingSink& sink) {
  if (request.capture_alignment != nullptr) {
    throw RecordingFailed(
        "its capture_alignment moves frames away from the exposures that were played, which are "
        "the truth here");
  }
  const bool has_programs = runs_programs(scenario_, request.pipeline);
  if (has_programs && !options_.namespaces) {
    throw RecordingFailed("its programs need network namespaces, which are not permitted here");
  }
  try {
    const std::string recording = record_cameras(request.seed);
    hardware::ExperimentRig rig({.scenario = &scenario_,
                                 .recording = recording,
                                 .clocks = hardware::draw_clock_starts(scenario_, request.seed),
                                 .seed = request.seed,
                                 .namespaces = options_.namespaces,
                                 .programs = has_programs,
                                 .program_log = program_log(request.seed),
                                 .program = own_program().path,
                                 .leading = own_program().leading});
    hardware::RigSource source(rig.conductor(), rig.key(), scenario_,
                               {.progress = options_.progress,
                                .prompt = {},
                                .cancelled = options_.cancelled,
                                .collect_session = {}});
    KeptRecording captured;
    RecordingCost cost = source.record(request, captured);
    const std::optional<MonotonicTime> zero = rig.trigger_zero();
    if (!zero) throw RecordingFailed("the trigger was never switched on");
    add_truth({.played = played_, .zero = *zero, .oscillators = oscillators_of(source)}, captured,
              sink);
    if (options_.relay_statistics) options_.relay_statistics(rig.end_relay());
    return cost;
  } catch (const hardware::ChildError& error) {
    throw RecordingFailed(error.what());
  } catch (const hardware::SandboxError& error) {
    throw RecordingFailed(error.what());
  }
}

void add_truth(const ExperimentTruth& truth, const KeptRecording& captured, RecordingSink& sink) {
  TruthAdder(truth, captured, sink).hand_over(captured);
}

}  // namespace simbench::app
