#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/registry.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/parameter_text.h"
#include "recording/collected.h"
#include "reports/figures/figure.h"
#include "reports/text/block.h"
#include "reports/text/plain_text.h"
#include "scenarios/camera_profile.h"
#include "scenarios/oscillator_class.h"
#include "scenarios/part.h"
#include "scenarios/study.h"

namespace simbench::cli {
namespace {

using reports::Align;
using reports::Field;
using reports::Table;

constexpr const char* kListExamples = R"(
Examples:
  simbench list                                       everything by name
  simbench list algorithms                            with parameters and sources
  simbench list cameras                               what each camera model can do
  simbench list oscillators                           classes of oscillators and their sources
  simbench list parts                                 parts of rigs, for simbench advise
  simbench list scenarios --format names              for scripts: one name a line
  simbench list pipelines --scenario 18cam_6host_45fps)";

// Variants have no entries of their own (algorithms/device_time/variants.h).
constexpr const char* kVariants = R"(
Any device_time but the oracle may be named with suffixes, as in hull_300_steady_calibrated:
  _steady              fitted on the host's steady clock, mapped by the log of clock adjustments
  _exposure_corrected  arrivals less half of the exposure
  _calibrated          the same, less the delay (and polls' asymmetry) of the camera model,
                       /cameras/streams/N/calibrated_delay_ms, /cameras/clock_poll
  _sdk                 on librealsense's arrivals: whole milliseconds of the system clock
)";

struct ListOptions {
  std::string what;
  std::string scenario = "18cam_6host_45fps";
  std::string format;
};

std::string scenarios_text() {
  std::string text = "scenarios\n";
  for (const auto& scenario : scenarios::builtin_scenarios()) {
    text += fmt::format("  {}\n{}", scenario.name, reports::wrapped(scenario.summary, 6));
  }
  return text;
}

// Lists the names for scripts, one a line.
std::string bare_names(const ListOptions& options) {
  std::vector<std::string> names;
  const auto add = [&names](const auto& list, const auto& name) {
    for (const auto& each : list) names.push_back(std::invoke(name, each));
  };
  const std::string& what = options.what;
  if (what.empty() || what == "scenarios") {
    add(scenarios::builtin_scenarios(), &scenarios::BuiltinScenario::name);
  }
  if (what.empty() || what == "algorithms") {
    for (const StageInfo& stage : kPipelineStages) {
      add(algorithms_of(stage.id), &AlgorithmInfo::name);
    }
  }
  if (what == "pipelines") {
    add(scenarios::load_scenario(options.scenario).pipelines, &scenarios::Pipeline::name);
  }
  if (what == "cameras") add(scenarios::camera_profiles(), &scenarios::CameraProfile::model);
  if (what == "oscillators") {
    add(scenarios::oscillator_classes(), &scenarios::OscillatorClass::class_name);
  }
  if (what == "parts") add(scenarios::parts(), &scenarios::Part::part);
  if (what == "studies") add(scenarios::studies(), &scenarios::Study::name);
  if (what == "figures") add(reports::figure_catalogue(), &reports::FigureEntry::id);
  return fmt::format("{}\n", fmt::join(names, "\n"));
}

std::string names_text(const StageInfo& stage) {
  Table table({{stage.name, Align::kLeft}, {"what it is", Align::kLeft}});
  for (const AlgorithmInfo* const info : algorithms_of(stage.id)) {
    table.add({info->name, info->summary});
  }
  return plain(table);
}

std::string algorithm_text(const AlgorithmInfo& info) {
  std::string text = fmt::format("\n{}: {}\n  source: {}\n", info.name, info.summary, info.source);
  if (info.parameters.empty()) return text;
  text += fmt::format("  parameters, in a scenario below /algorithms/{}:\n", info.family);
  for (const ParameterSpec& spec : info.parameters) {
    text += fmt::format("    {} = {} ({}): {} [{}]\n", spec.name, default_text(spec),
                        range_text(spec), spec.meaning, spec.source);
  }
  return text;
}

std::string details_text(const StageInfo& stage) {
  std::string text = fmt::format("== {}\n", stage.name);
  for (const AlgorithmInfo* const info : algorithms_of(stage.id)) text += algorithm_text(*info);
  return text;
}

// The text of each stage, with the suffixes of device times below theirs.
std::string stages_text(std::string (*text_of)(const StageInfo&)) {
  std::string text;
  for (const StageInfo& stage : kPipelineStages) {
    text += (text.empty() ? "" : "\n") + text_of(stage);
    if (stage.id == PipelineStage::kDeviceTime) text += kVariants;
  }
  return text;
}

std::string pipelines_text(const std::string& scenario) {
  const std::vector<scenarios::Pipeline> pipelines = scenarios::load_scenario(scenario).pipelines;
  std::vector<Field<scenarios::Pipeline>> fields = {
      {{"pipeline", Align::kLeft}, &scenarios::Pipeline::name}};
  for (const StageInfo& stage : present_stages(pipelines)) {
    fields.push_back({{stage.name, Align::kLeft}, [id = stage.id](const auto& pipeline) {
                        const std::string& name = at_stage(pipeline, id);
                        return name.empty() ? std::string("-") : name;
                      }});
  }
  return plain(reports::table_of(fields, pipelines));
}

constexpr std::size_t kListIndent = 2;
constexpr std::size_t kDeeper = 4;

std::string stream_text(const scenarios::StreamProfile& stream) {
  std::string text = reports::wrapped(
      fmt::format("{}: {}, {} shutter, {} bytes a pixel [{}]", to_text(stream.kind), stream.format,
                  to_text(stream.shutter), stream.bytes_per_pixel, stream.source),
      kListIndent);
  for (const scenarios::ImageSize& size : stream.sizes) {
    text += fmt::format("{:{}}{}x{} at {} Hz\n", "", kDeeper, size.width, size.height,
                        fmt::join(size.rates_hz, ", "));
  }
  return text;
}

std::string sync_text(const scenarios::CameraProfile& camera) {
  std::vector<std::string> modes;
  for (const scenarios::SyncModeProfile& mode : camera.sync_modes) {
    std::vector<std::string_view> triggered;
    for (const scenarios::StreamKind kind : mode.triggered) triggered.push_back(to_text(kind));
    modes.push_back(triggered.empty()
                        ? fmt::format("{} (runs free)", to_text(mode.mode))
                        : fmt::format("{} (the trigger drives {}{})", to_text(mode.mode),
                                      fmt::join(triggered, " and "),
                                      mode.begins_at_pulse ? ", from the pulse on" : ""));
  }
  return reports::wrapped(fmt::format("sync modes: {}. {} [{}]", fmt::join(modes, ", "),
                                      camera.sync_wiring, camera.sync_source),
                          kListIndent);
}

std::string stamp_text(const scenarios::StampProfile& stamp) {
  const std::string wrap =
      stamp.wraps_after_s ? fmt::format(", wraps after {} s", *stamp.wraps_after_s) : "";
  return reports::wrapped(fmt::format("stamp {}: {} clock, {}{}: {} [{}]", stamp.stamp, stamp.clock,
                                      stamp.unit, wrap, stamp.meaning, stamp.source),
                          kListIndent);
}

std::string latency_text(const scenarios::CameraProfile& camera) {
  if (camera.typical_latency_ms.empty()) {
    return reports::wrapped(fmt::format("latency: {}", camera.latency_source), kListIndent);
  }
  return reports::wrapped(
      fmt::format("latency: {} ms [{}]", fmt::join(camera.typical_latency_ms, " to "),
                  camera.latency_source),
      kListIndent);
}

std::string frame_control_text(const scenarios::FrameControlProfile& control) {
  std::vector<std::string_view> offered;
  if (control.adjust_frame) offered.emplace_back("adjust_frame");
  if (control.insert_frame) offered.emplace_back("insert_frame");
  if (control.frame_length) offered.emplace_back("frame_length");
  if (control.start_at) offered.emplace_back("start_at");
  if (offered.empty()) offered.emplace_back("none");
  return reports::wrapped(
      fmt::format("controls of its frames: {} [{}]", fmt::join(offered, ", "), control.source),
      kListIndent);
}

// The profiles of all camera models, with their sources.
std::string camera_list_text() {
  std::string text;
  for (const scenarios::CameraProfile& camera : scenarios::camera_profiles()) {
    text += fmt::format("{}{}: {}, {}\n", text.empty() ? "" : "\n", camera.model, camera.name,
                        camera.maker);
    for (const scenarios::StreamProfile& stream : camera.streams) text += stream_text(stream);
    text += sync_text(camera);
    for (const scenarios::StampProfile& stamp : camera.stamps) text += stamp_text(stamp);
    text += latency_text(camera);
    if (camera.frame_control) text += frame_control_text(*camera.frame_control);
  }
  return text;
}

// The classes of oscillators, with their values and sources.
std::string oscillator_list_text() {
  std::string text;
  for (const scenarios::OscillatorClass& each : scenarios::oscillator_classes()) {
    text += fmt::format("{}{}: {}\n", text.empty() ? "" : "\n", each.class_name, each.name);
    for (const scenarios::OscillatorValue& value : each.values) {
      text += reports::wrapped(fmt::format("{} = {} [{}]", value.member, value.value, value.source),
                               kListIndent);
    }
  }
  return text;
}

std::string price_text(const scenarios::PartPrice& price) {
  return fmt::format("{:g} to {:g} EUR a {}", price.range.low_eur, price.range.high_eur,
                     to_text(price.per));
}

// The parts of rigs, with their prices, what they set and make possible.
std::string part_list_text() {
  std::string text;
  const auto add = [&text](const std::string& line) {
    text += reports::wrapped(line, kListIndent);
  };
  for (const scenarios::Part& part : scenarios::parts()) {
    text += fmt::format("{}{} ({}): {}\n", text.empty() ? "" : "\n", part.part, to_text(part.kind),
                        part.name);
    std::vector<std::string> prices = collected(part.prices, price_text);
    if (prices.empty()) prices = {"nothing"};
    add(fmt::format("price: {} [{}]", fmt::join(prices, " and "), part.price_source));
    if (part.cameras > 0) add(fmt::format("cameras = {}", part.cameras));
    if (part.slots > 0) add(fmt::format("slots = {}", part.slots));
    if (!part.world.empty()) add(fmt::format("as in: {}", part.world));
    if (!part.capture_alignment.empty()) {
      add(fmt::format("capture_alignment: {}", fmt::join(part.capture_alignment, ", ")));
    }
    if (part.hosts > 0) add(fmt::format("hosts = {}", part.hosts));
    for (const scenarios::Override& set : part.sets) {
      add(fmt::format("{} = {}", set.pointer, set.value));
    }
    if (!part.host_sync.empty()) {
      add(fmt::format("host_sync: {}", fmt::join(part.host_sync, ", ")));
    }
    if (!part.with.empty()) add(fmt::format("only with: {}", fmt::join(part.with, ", ")));
    add(fmt::format("source: {}", part.source));
  }
  return text;
}

std::string listing(const ListOptions& options) {
  if (options.format == "names") return bare_names(options);
  if (options.what == "scenarios") return scenarios_text();
  if (options.what == "cameras") {
    return options.format == "json" ? scenarios::camera_profiles_json() : camera_list_text();
  }
  if (options.what == "oscillators") return oscillator_list_text();
  if (options.what == "parts") return part_list_text();
  if (options.what == "pipelines") return pipelines_text(options.scenario);
  if (options.what == "studies") return study_list();
  if (options.what == "figures") return figure_list();
  if (options.what == "algorithms") return stages_text(details_text);
  return scenarios_text() + "\n" + stages_text(names_text);
}

}  // namespace

std::string study_list() {
  std::string text = "studies\n";
  for (const scenarios::Study& study : scenarios::studies()) {
    text += fmt::format("  {}\n{}", study.name, reports::wrapped(study.summary, 6));
  }
  return text;
}

void add_list_command(CommandLine& line) {
  auto options = std::make_shared<ListOptions>();
  Command command(
      line, "list",
      "List scenarios, algorithms, pipelines, cameras, oscillators, parts, studies or figures");
  command.word("what", "WHAT", options->what,
               {"scenarios", "pipelines", "algorithms", "cameras", "oscillators", "parts",
                "studies", "figures"},
               "scenarios, pipelines, algorithms (with parameters and sources), cameras, "
               "oscillators, parts of rigs, studies or figures.\nDefault: scenarios and algorithms "
               "by name");
  command.text("--scenario", "SCENARIO", options->scenario,
               "The scenario whose pipelines to list. Default: " + options->scenario);
  command.python();
  command.format(options->format, {"text", "names", "json"});
  command.footer(kListExamples);
  const auto check = [options] {
    if (options->format == "json" && options->what != "cameras") {
      refuse("--format", "found 'json', allowed: with cameras only");
    }
  };
  command.runs(
      [options] {
        print_result(options->format == "text" ? reports::fitted(listing(*options))
                                               : listing(*options));
        return kOk;
      },
      check);
}

}  // namespace simbench::cli
