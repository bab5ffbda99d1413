#include "evaluation/run/pipeline_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/coded_trigger/coded_pulses.h"
#include "algorithms/parameters.h"
#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "evaluation/scoring/claims.h"
#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/program_failures.h"
#include "recording/forwarding_sink.h"
#include "recording/program_failure.h"
#include "scenarios/calibration.h"
#include "scenarios/camera_groups.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"
#include "scenarios/trigger_code.h"

namespace simbench::evaluation {
namespace {

using scenarios::Scenario;

constexpr std::int64_t kMostFramesKept = 200'000;

// found "genlok", did you mean genlock? Known: genlock, yoon2021
std::string unknown(const std::string& name, const std::vector<std::string>& known) {
  const std::vector<std::string> near = scenarios::nearest(name, known);
  const std::string guess =
      near.empty() ? "" : fmt::format(", did you mean {}? Known", fmt::join(near, " or "));
  return fmt::format("found \"{}\"{}: {}", name, guess.empty() ? ", known" : guess,
                     fmt::join(known, ", "));
}

std::vector<const AlgorithmInfo*> all_algorithms() {
  std::vector<const AlgorithmInfo*> infos;
  for (const StageInfo& stage : kPipelineStages) {
    std::ranges::copy(algorithms_of(stage.id), std::back_inserter(infos));
  }
  return infos;
}

bool declares(const AlgorithmInfo& info, const std::string& parameter) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [&](const ParameterSpec& spec) { return spec.name == parameter; });
}

std::string parameter_pointer(const std::string& key, const std::string& parameter) {
  return scenarios::child_pointer(scenarios::child_pointer("/algorithms", key), parameter);
}

// Requires that an algorithm of that name or family declares the parameter, and allows its value.
void check_parameter(const Scenario& scenario, const std::string& key, const std::string& parameter,
                     const ParameterValue& value, const std::vector<const AlgorithmInfo*>& named) {
  const std::string pointer = parameter_pointer(key, parameter);
  bool declared = false;
  std::vector<std::string> known;
  for (const AlgorithmInfo* info : named) {
    for (const ParameterSpec& spec : info->parameters) {
      if (std::find(known.begin(), known.end(), spec.name) == known.end()) {
        known.push_back(spec.name);
      }
      if (spec.name != parameter) continue;
      declared = true;
      try {
        check_parameters({spec}, {{parameter, value}});
      } catch (const ParameterError& error) {
        scenarios::fail_at(scenario, pointer, error.what());
      }
    }
  }
  if (declared) return;
  scenarios::fail_at(
      scenario, pointer,
      known.empty() ? fmt::format("\"{}\" has no parameters", key) : unknown(parameter, known));
}

// Blames the place where the scenario sets the parameter.
[[noreturn]] void fail_at_parameter(const Scenario& scenario, const AlgorithmInfo& info,
                                    const ParameterError& error) {
  for (const std::string& key : {info.name, info.family}) {
    const auto found = scenario.algorithms.find(key);
    if (found == scenario.algorithms.end() || !found->second.contains(error.parameter())) continue;
    scenarios::fail_at(scenario, parameter_pointer(key, error.parameter()), error.what());
  }
  scenarios::fail_at(scenario, scenarios::child_pointer("/algorithms", info.family), error.what());
}

Parameters parameters_of(const Scenario& scenario, const AlgorithmInfo& info) {
  ParameterValues given;
  for (const std::string& key : {info.family, info.name}) {
    const auto found = scenario.algorithms.find(key);
    if (found == scenario.algorithms.end()) continue;
    for (const auto& [parameter, value] : found->second) {
      if (declares(info, parameter)) given[parameter] = value;
    }
  }
  try {
    return check_parameters(info.parameters, given);
  } catch (const ParameterError& error) {
    fail_at_parameter(scenario, info, error);
  }
}

void check_all_parameters(const Scenario& scenario) {
  const std::vector<const AlgorithmInfo*> infos = all_algorithms();
  for (const auto& [key, parameters] : scenario.algorithms) {
    std::vector<const AlgorithmInfo*> named;
    std::vector<std::string> known;
    for (const AlgorithmInfo* info : infos) {
      for (const std::string& name : {info->family, info->name}) {
        if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
      }
      if (info->family == key || info->name == key) named.push_back(info);
    }
    if (named.empty()) {
      scenarios::fail_at(scenario, scenarios::child_pointer("/algorithms", key),
                         unknown(key, known));
    }
    for (const auto& [parameter, value] : parameters) {
      check_parameter(scenario, key, parameter, value, named);
    }
    for (const AlgorithmInfo* info : named) parameters_of(scenario, *info);
  }
}

// Makes each algorithm once: one of a user's own may refuse what its declaration allows.
void check_can_be_made(const Scenario& scenario, const PipelineChoice& choice) {
  const auto try_to_make = [&scenario](const auto& chosen, const auto&... setup) {
    if (!chosen.can_be_made()) return;
    try {
      chosen.make(setup...);
    } catch (const ParameterError& error) {
      fail_at_parameter(scenario, chosen.info(), error);
    }
  };
  const Nanoseconds period = from_ms(1e3 / scenario.trigger.rate_hz);
  try_to_make(choice.host_sync);
  try_to_make(choice.capture_alignment);
  try_to_make(choice.device_time);
  try_to_make(
      choice.gathering,
      GatheringSetup{
          .sources = 1, .period = period, .interval = period, .pulses = coded_pulses(scenario)});
}

std::string stage_pointer(std::size_t pipeline, PipelineStage stage) {
  return fmt::format("/pipelines/{}/{}", pipeline, name_of(stage));
}

// Hosts that follow another slave need a protocol whose slaves can serve.
void check_relays(const Scenario& scenario, std::size_t index, const PipelineChoice& choice) {
  const std::vector<std::int64_t>& follows = scenario.hosts.follows;
  const bool is_star = std::ranges::all_of(follows, [](std::int64_t host) { return host == 0; });
  if (is_star || !choice.host_sync.can_be_made() || choice.host_sync.make()->can_relay()) return;
  std::vector<std::string> known;
  for (const HostSyncEntry& entry : algorithms<HostSyncEntry>()) {
    if (entry.make(check_parameters(entry.info.parameters, {}))->can_relay()) {
      known.push_back(entry.info.name);
    }
  }
  scenarios::fail_at(scenario, stage_pointer(index, PipelineStage::kHostSync),
                     fmt::format("found \"{}\", whose slaves serve no others, where hosts follow "
                                 "slaves (/hosts/follows); allowed: {}, or programs",
                                 choice.pipeline.host_sync, fmt::join(known, ", ")));
}

// What it lacks of a radio whose time programs can use; `member` of the cell says whether they can.
std::string lacking_radio(const Scenario& scenario, const char* member, bool is_stated) {
  const std::optional<scenarios::Wifi>& wifi = scenario.network.wifi;
  if (!wifi) {
    return fmt::format(
        "an access point for its stations (there is no /network/wifi; state a cell "
        "with \"{}\", or choose a host_sync that sends messages)",
        member);
  }
  if (!is_stated) {
    return fmt::format(
        "stations that can use the access point's time (there is no "
        "/network/wifi/{}; state it)",
        member);
  }
  if (wifi->wired_hosts.empty()) return "";
  return fmt::format("a radio in every host (/network/wifi/wired_hosts has host {}; take it out)",
                     wifi->wired_hosts.front());
}

// What the scenario lacks of an algorithm's need; empty if nothing.
std::string lacking(const Scenario& scenario, Need need) {
  const scenarios::PulseLines& lines = scenario.hosts.pulse_lines;
  switch (need) {
    case Need::kHardwareStamps:
      return scenario.hosts.nic.hardware_stamps
                 ? ""
                 : "network cards with a clock (/hosts/nic/hardware_stamps is false)";
    case Need::kPps:
      return lines.pps ? "" : "a pulse per second (/hosts/pulse_lines/pps is false)";
    case Need::kGnss:
      return lines.gnss ? "" : "a GNSS receiver (/hosts/pulse_lines/gnss is false)";
    case Need::kTriggerLine:
      return lines.trigger ? "" : "the trigger wired in (/hosts/pulse_lines/trigger is false)";
    case Need::kTsf:
      return lacking_radio(scenario, "tsf", scenario.network.wifi && scenario.network.wifi->tsf);
    case Need::kFtm:
      return lacking_radio(scenario, "ftm", scenario.network.wifi && scenario.network.wifi->ftm);
    case Need::kFrameControl:
      return scenario.cameras.frame_control
                 ? ""
                 : "cameras whose frames can be controlled (there is no /cameras/frame_control)";
    case Need::kPolls:
      return scenario.cameras.clock_poll.is_on()
                 ? ""
                 : "polls of the cameras' clocks (/cameras/clock_poll/interval_ms is 0)";
    case Need::kHostStamps:
      return scenario.cameras.stamp_clock == scenarios::ClockOwner::kHost
                 ? ""
                 : "cameras that stamp with their host's clock (/cameras/stamp_clock is not "
                   "\"host\")";
    case Need::kLedClock:
      return scenario.cameras.led_clock
                 ? ""
                 : "a clock of LEDs that the cameras see (there is no /cameras/led_clock)";
    case Need::kTriggerCode:
      return scenario.trigger.code ? "" : "a coded trigger (there is no /trigger/code)";
    case Need::kFrames:
    case Need::kTruth:
      return "";
  }
  return "";
}

void check_needs(const Scenario& scenario, std::size_t pipeline, PipelineStage stage,
                 const AlgorithmInfo& info) {
  for (const Need need : info.needs) {
    const std::string missing = lacking(scenario, need);
    if (missing.empty()) continue;
    scenarios::fail_at(scenario, stage_pointer(pipeline, stage),
                       fmt::format("found \"{}\", which needs {}", info.name, missing));
  }
}

// Stamps that are rounded down to steps are half a step early on average.
CalibratedDelays calibrated_delays(const Scenario& scenario) {
  CalibratedDelays delays;
  delays.poll_asymmetry = from_ms(scenarios::calibrated_asymmetry_ms(scenario.cameras.clock_poll));
  if (const scenarios::Stream* scored = scenario.scored_stream()) {
    delays.arrival = from_ms(scenarios::calibrated_delay_ms(scenario, *scored));
  }
  return delays;
}

std::vector<CalibratedDelays> delays_of_groups(const Scenario& scenario) {
  std::vector<CalibratedDelays> delays;
  for (std::size_t group = 0; group < scenarios::group_count(scenario.cameras); ++group) {
    delays.push_back(calibrated_delays(scenarios::group_alone(scenario, group)));
  }
  return delays;
}

Nanoseconds earlier_by_sdk(const Scenario& scenario) {
  const Nanoseconds quantum = from_ms(scenario.hosts.clock.arrival_quantum_ms);
  return quantum < kSdkResolution ? (kSdkResolution - quantum) / 2 : Nanoseconds(0);
}

// What the pipeline's device_time subtracts, of each group of cameras.
std::vector<CalibratedDelays> delays_of(const Scenario& scenario, const PipelineChoice& choice) {
  if (!choice.device_time_variants.calibrated) {
    return std::vector<CalibratedDelays>(scenarios::group_count(scenario.cameras));
  }
  std::vector<CalibratedDelays> delays = choice.delays();
  for (CalibratedDelays& each : delays) {
    if (choice.device_time_variants.sdk) each.arrival -= earlier_by_sdk(scenario);
  }
  return delays;
}

template <class Entry>
const Entry& algorithm_at(const Scenario& scenario, std::size_t pipeline, const std::string& name) {
  if (const Entry* const entry = find_algorithm<Entry>(name)) return *entry;
  std::vector<std::string> known;
  for (const Entry& entry : algorithms<Entry>()) known.push_back(entry.info.name);
  scenarios::fail_at(scenario, stage_pointer(pipeline, Entry::kStage), unknown(name, known));
}

ProgramMaker& program_maker() {
  static ProgramMaker maker;
  return maker;
}

ProgramEntry host_sync_of(const Scenario& scenario, std::size_t index) {
  const scenarios::Pipeline& pipeline = scenario.pipelines[index];
  if (!pipeline.programs) {
    return {algorithm_at<HostSyncEntry>(scenario, index, pipeline.host_sync)};
  }
  if (!program_maker()) {
    scenarios::fail_at(scenario, stage_pointer(index, PipelineStage::kHostSync),
                       "found programs, allowed here: an algorithm");
  }
  return program_maker()(scenario, pipeline);
}

// A stage that is absent has an entry without a name.
template <class Entry>
Entry chosen_at(const Scenario& scenario, std::size_t index, const std::string& name) {
  if (name.empty()) return {};
  return algorithm_at<Entry>(scenario, index, name);
}

PipelineChoice choose(const Scenario& scenario, std::size_t index) {
  const scenarios::Pipeline& pipeline = scenario.pipelines[index];
  const auto [host_sync, problem] = host_sync_of(scenario, index);
  const auto alignment =
      chosen_at<CaptureAlignmentEntry>(scenario, index, pipeline.capture_alignment);
  check_needs(scenario, index, PipelineStage::kCaptureAlignment, alignment.info);
  const DeviceTimeName variants = parse_device_time_name(pipeline.device_time);
  const auto& device_time = algorithm_at<DeviceTimeEntry>(scenario, index, variants.base);
  const auto& gathering = algorithm_at<GatheringEntry>(scenario, index, pipeline.gathering);
  check_needs(scenario, index, PipelineStage::kHostSync, host_sync.info);
  check_needs(scenario, index, PipelineStage::kDeviceTime, device_time.info);
  check_needs(scenario, index, PipelineStage::kGathering, gathering.info);
  if (!device_time.make && variants.base != pipeline.device_time) {
    scenarios::fail_at(scenario, stage_pointer(index, PipelineStage::kDeviceTime),
                       fmt::format("found \"{}\", but \"{}\" has no variants", pipeline.device_time,
                                   variants.base));
  }
  PipelineChoice choice = {
      .pipeline = pipeline,
      .host_sync = {host_sync, parameters_of(scenario, host_sync.info)},
      .capture_alignment = {alignment, parameters_of(scenario, alignment.info)},
      .device_time = {device_time, parameters_of(scenario, device_time.info)},
      .device_time_variants = variants,
      .gathering = {gathering, parameters_of(scenario, gathering.info)},
      .scores_offline = needs_offline_amd(pipeline.name),
      .problem = problem};
  check_can_be_made(scenario, choice);
  check_relays(scenario, index, choice);
  return choice;
}

// The ids of the metrics that each seed has a value of.
std::vector<std::string> known_series() {
  std::vector<std::string> known;
  for (const Metric& each : metrics()) {
    if (each.is_series()) known.emplace_back(each.id);
  }
  return known;
}

void check_figure(const Scenario& scenario, const std::string& pointer,
                  const scenarios::PublishedFigure& figure) {
  const auto found = std::ranges::find_if(
      metrics(), [&figure](const Metric& each) { return each.id == figure.metric; });
  if (found == metrics().end()) {
    scenarios::fail_at(scenario, pointer + "/metric",
                       unknown(scenarios::shown_text(figure.metric), known_series()));
  }
  if (!found->is_series()) {
    scenarios::fail_at(scenario, pointer + "/metric",
                       fmt::format("found \"{}\", which has no value of each seed, allowed: {}",
                                   figure.metric, fmt::join(known_series(), ", ")));
  }
  if (found->can_be(figure.number())) return;
  scenarios::fail_at(
      scenario, fmt::format("{}/{}", pointer, figure.number_name()),
      fmt::format("found {}, allowed {} ({})", figure.number(),
                  found->is_share() ? "a share from 0 to 1" : "a number from 0", figure.metric));
}

// Only here are the metrics known.
void check_published_figures(const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.published_figures.size(); ++i) {
    check_figure(scenario, fmt::format("/published_figures/{}", i), scenario.published_figures[i]);
  }
}

}  // namespace

std::shared_ptr<const CodedPulses> coded_pulses(const Scenario& scenario) {
  const std::optional<TriggerCode> code = scenarios::trigger_code(scenario.trigger);
  if (!code) return nullptr;
  return std::make_shared<const CodedPulses>(
      CodedPulses{.code = *code, .exposures_begin_at_pulse = scenario.cameras.begins_at_pulse()});
}

void set_program_maker(ProgramMaker maker) { program_maker() = std::move(maker); }

std::vector<PipelineChoice> choose_pipelines(const Scenario& scenario,
                                             const std::vector<std::string>& names) {
  check_all_parameters(scenario);
  check_published_figures(scenario);
  std::vector<PipelineChoice> all;
  std::vector<std::string> known;
  const scenarios::Lazy<std::vector<CalibratedDelays>> delays(
      [scenario] { return delays_of_groups(scenario); });
  for (std::size_t index = 0; index < scenario.pipelines.size(); ++index) {
    all.push_back(choose(scenario, index));
    all.back().delays = delays;
    known.push_back(scenario.pipelines[index].name);
  }
  if (names.empty()) return all;

  std::vector<PipelineChoice> chosen;
  for (auto name = names.begin(); name != names.end(); ++name) {
    const auto found = std::find(known.begin(), known.end(), *name);
    if (found == known.end()) {
      throw scenarios::InputError(
          fmt::format("pipelines of {}: {}; others by their algorithms, as {}", scenario.name,
                      unknown(*name, known), stages_formula(kPipelineStages)));
    }
    if (std::find(names.begin(), name, *name) != name) {
      throw scenarios::InputError(fmt::format("pipelines: \"{}\" is named twice", *name));
    }
    chosen.push_back(all[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

const Scenario& scoring_scenario(const Scenario& scenario, const PipelineChoice& choice) {
  return choice.scored_in ? *choice.scored_in : scenario;
}

namespace {

// Groups of cameras that answer different pulses.
void count_unequal_rates(const Scenario& scenario, ScorerSetup& setup) {
  for (const scenarios::CameraGroup& group : scenario.cameras.groups) {
    setup.due_every = std::lcm(setup.due_every, group.pulses_per_frame);
  }
  if (setup.due_every == 1) return;
  std::vector<std::int64_t> of_group;
  for (std::size_t group = 0; group < scenarios::group_count(scenario.cameras); ++group) {
    const scenarios::Scenario alone = scenarios::group_alone(scenario, group);
    of_group.push_back(alone.pulses_per_passed_frame(*alone.scored_stream()) *
                       scenarios::pulses_per_frame(scenario.cameras, group));
  }
  for (const std::size_t group : scenarios::group_of_cameras(scenario.cameras)) {
    setup.pulses_per_frame_of_camera.push_back(of_group[group]);
  }
}

}  // namespace

ScorerSetup scorer_setup(const Scenario& scenario, const PipelineChoice& choice) {
  ScorerSetup setup;
  setup.stream = scenario.evaluation.stream;
  setup.median = scenario.evaluation.rmdv_median;
  setup.genlock =
      scenario.cameras.sync_mode == scenarios::SyncMode::kGenlock && !choice.is_steered();
  setup.is_steered = choice.is_steered() || scenario.cameras.frame_control.has_value();
  setup.unsteady_start = from_ms(scenario.cameras.unstable_start_ms);
  setup.has_depth_and_colour = scenario.cameras.stream(StreamKind::kDepth) != nullptr &&
                               scenario.cameras.stream(StreamKind::kColour) != nullptr;
  setup.gathering_interval_periods = scenario.evaluation.gathering_interval_periods;
  if (const auto frames = scenario.evaluation.gathering_queue_frames) {
    setup.gathering_queue_frames = static_cast<std::uint32_t>(*frames);
  }
  if (const scenarios::Stream* scored = scenario.scored_stream()) {
    setup.pulses_per_frame = scenario.pulses_per_passed_frame(*scored);
  }
  count_unequal_rates(scenario, setup);
  const std::shared_ptr<const CodedPulses> pulses = coded_pulses(scenario);
  const scenarios::HostClockModel& clock = scenario.hosts.clock;
  setup.make_gatherer =
      [chosen = choice.gathering, pulses,
       step = from_ms(clock.tick_ms + clock.resolution_ms)](GatheringSetup gathering) {
        gathering.pulses = pulses;
        gathering.host_clock_step = step;
        return chosen.make(gathering);
      };
  setup.gatherer_needs_pulses = choice.pipeline.gathering == "oracle";
  if (choice.device_time.can_be_made()) {
    setup.make_estimator = [chosen = choice.device_time, variants = choice.device_time_variants,
                            groups = scenarios::group_of_cameras(scenario.cameras),
                            delays = delays_of(scenario, choice), pulses](std::size_t camera) {
      const std::size_t group = delays.size() == 1 ? 0 : groups.at(camera);
      auto estimator = make_variant(variants, chosen.make(), delays[group]);
      if (pulses) estimator->on_coded_pulses(pulses);
      return estimator;
    };
  }
  const DeviceTimeEntry* offline = find_algorithm<DeviceTimeEntry>("regression_offline");
  if (choice.scores_offline && offline != nullptr &&
      scenario.timeline.frames * scenario.cameras.count <= kMostFramesKept) {
    setup.make_second_estimator =
        [make = offline->make, parameters = parameters_of(scenario, offline->info)](std::size_t) {
          return make(parameters);
        };
  }
  return setup;
}

namespace {

// Keeps the failures of programs that pass.
class ProgramWatch final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;
  void on_event(const RecordingEvent& event) override {
    if (const auto* failure = std::get_if<ProgramFailure>(&event)) failures.push_back(*failure);
    sink().on_event(event);
  }

  std::vector<ProgramFailure> failures;
};

}  // namespace

RecordingCost record_run(RecordingSource& source, const PipelineChoice& choice, std::uint64_t seed,
                         RecordingSink& sink, WorldObserver* observer,
                         const ShareDone& share_done) {
  if (!choice.problem.empty() && source.runs_host_sync()) throw RecordingFailed(choice.problem);
  const std::unique_ptr<HostSync> host_sync = choice.host_sync.make();
  std::unique_ptr<CaptureAlignment> alignment;
  if (choice.is_steered()) {
    alignment = choice.capture_alignment.make();
  }
  ProgramWatch watch(sink);
  RecordingCost cost = source.record({.seed = seed,
                                      .pipeline = choice.pipeline.name,
                                      .host_sync = host_sync.get(),
                                      .capture_alignment = alignment.get(),
                                      .observer = observer,
                                      .share_done = share_done},
                                     choice.pipeline.programs ? watch : sink);
  std::ranges::move(host_sync->notes(), std::back_inserter(cost.notes));
  // Where they ran in this process, and in a replayed recording, they are among the notes.
  std::ranges::copy_if(failure_lines(watch.failures), std::back_inserter(cost.notes),
                       [&cost](const std::string& line) {
                         return std::ranges::find(cost.notes, line) == cost.notes.end();
                       });
  cost.program_failures = std::move(watch.failures);
  return cost;
}

SeedScore captured_score(PipelineScorer& scorer, RecordingCost cost, std::uint64_t seed) {
  SeedScore score = scorer.finish();
  score.seed = seed;
  if (cost.messages && cost.simulated_seconds > 0) {
    score.packets_per_s = static_cast<double>(*cost.messages) / cost.simulated_seconds;
  }
  std::ranges::move(score.cost.notes, std::back_inserter(cost.notes));
  score.cost = std::move(cost);
  void_score(score);
  return score;
}

SeedScore score_run(RecordingSource& source, const PipelineChoice& choice, std::uint64_t seed,
                    PipelineScorer& scorer, RecordingSink& sink, WorldObserver* observer) {
  return captured_score(scorer, record_run(source, choice, seed, sink, observer), seed);
}

}  // namespace simbench::evaluation
