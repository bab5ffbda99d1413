#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "app/rare_sets.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/progress.h"
#include "evaluation/advice/advice.h"
#include "recording/number_in.h"
#include "reports/advice/advice_report.h"
#include "reports/text/json_node.h"
#include "scenarios/document.h"

namespace simbench::cli {
namespace {

constexpr const char* kAdviseExamples = R"(
Examples:
  simbench advise --require 'amd<0.1ms' --cameras 24 --rate 60
  simbench advise --require 'error<0.2ms' --require 'recall>99%' --cameras 12 --rate 30 --hosts 2..4
  simbench advise --require 'exposure_spread<50us' --camera gige_ace --cameras 6 --rate 60
  simbench advise --require '5mm at 2m/s exposed 1ms' --cameras 12 --rate 30
  simbench advise --require 'amd<1ms' --cameras 18 --rate 45 --parts my_switch.json --format json
  simbench advise --require 'amd<0.1ms' --cameras 24 --rate 60 --per-day --bound-ms 0.06
  simbench advise --require 'amd<1ms' --cameras 24 --rate 60 --set /network/cross_traffic_share=0.3

A requirement is a metric, < or >, and a value with its unit. Rigs are put together from the parts
of `simbench list parts` in a nominal world, and simulated; prices are rough classes. The answer
comes first, then every rig from the cheapest on, then what was assumed.

Exit status: 0 ok (also if no rig meets it), 1 internal error, 2 bad usage or input,
130 interrupted.)";

constexpr std::int64_t kMostHosts = 24;

// The runs of both events together take some five minutes on two cores for 24 cameras at 60 Hz.
constexpr std::uint64_t kSpreadRuns = 6000;
constexpr std::uint64_t kWrongSetRuns = 5600;
constexpr std::size_t kRareStarts = 512;
constexpr std::size_t kRareChains = 32;
constexpr double kLeastProbability = 1e-8;

struct AdviseOptions {
  std::vector<std::string> require;
  evaluation::AdviceRequest request;
  evaluation::AdviceOptions advice;
  std::string hosts;
  std::vector<std::string> parts;
  std::vector<std::string> sets;
  std::string format;
  bool per_day = false;
  std::optional<double> bound_ms;
  std::string pipeline;
};

std::optional<std::int64_t> host_count(std::string_view text) {
  const auto number = number_in<std::int64_t>(text);
  return number && *number >= 1 && *number <= kMostHosts ? number : std::nullopt;
}

// "2..8" or "4"; nothing given: all that makes sense.
void set_hosts(const std::string& text, evaluation::RigRequest& rig) {
  if (text.empty()) return;
  const std::size_t dots = text.find("..");
  const auto low = host_count(std::string_view{text}.substr(0, dots));
  const auto high =
      dots == std::string::npos ? low : host_count(std::string_view{text}.substr(dots + 2));
  if (!low || !high || *low > *high) {
    throw scenarios::InputError(
        fmt::format("--hosts: found '{}', allowed: a number or a range FEWEST..MOST from 1 to {}, "
                    "as in 2..8",
                    scenarios::shown_text(text), kMostHosts));
  }
  rig.fewest_hosts = *low;
  rig.most_hosts = *high;
}

void add_parts(const std::vector<std::string>& files, evaluation::RigRequest& rig) {
  for (const std::string& file : files) {
    scenarios::Part part = scenarios::load_part(file);
    const auto is_same = [&part](const scenarios::Part& other) { return other.part == part.part; };
    if (scenarios::find_part(part.part) != nullptr ||
        std::ranges::any_of(rig.more_parts, is_same)) {
      throw scenarios::InputError(fmt::format(
          "{}: /part: found \"{}\", allowed a name that no other part has (simbench list parts)",
          file, part.part));
    }
    rig.more_parts.push_back(std::move(part));
  }
}

// The rig whose rare events are asked for, as a world with one pipeline.
struct RareWorld {
  std::string rig;
  std::string pipeline;
  scenarios::Scenario scenario;
};

// The recommended rig, or the cheapest that has the named pipeline. Nothing if there is none.
std::optional<RareWorld> rare_world(const evaluation::Advice& advice, const std::string& named) {
  for (std::size_t i = 0; i < advice.options.size(); ++i) {
    if (named.empty() && advice.recommended != i) continue;
    const evaluation::RigOption& option = advice.options[i].option;
    const std::string wanted = named.empty() ? advice.options[i].best().pipeline.name : named;
    for (const auto& pipeline : evaluation::candidate_pipelines(option, advice.request)) {
      if (pipeline.name != wanted) continue;
      return RareWorld{option.name(), wanted,
                       evaluation::scenario_of(option, advice.request.rig, {pipeline})};
    }
  }
  if (named.empty()) return std::nullopt;
  throw scenarios::InputError(
      fmt::format("--pipeline: found '{}', allowed a pipeline of these rigs, as in the table: "
                  "HOST_SYNC.DEVICE_TIME.GATHERING",
                  scenarios::shown_text(named)));
}

// The bound of the spread: --bound-ms, else that of a requirement of AMD, else gathering's
// interval.
double spread_bound_ms(const AdviseOptions& options, const scenarios::Scenario& scenario) {
  if (options.bound_ms) return *options.bound_ms;
  for (const evaluation::Requirement& each : options.request.requirements) {
    if (each.metric == &evaluation::metric("amd_ms")) return each.limit;
  }
  return 1e3 / scenario.trigger.pulse_rate_hz() * scenario.evaluation.gathering_interval_periods;
}

// Nothing if it was interrupted.
std::optional<std::vector<reports::RareResult>> rare_results(const AdviseOptions& options,
                                                             const RareWorld& world) {
  constexpr double kSecondsPerDay = 86400;
  const double spread_ms = spread_bound_ms(options, world.scenario);
  const double wrong_ms = app::wrong_set_bound_ms(world.scenario);
  std::vector<reports::RareResult> results = {
      {.event = fmt::format("spread above {:g} ms", spread_ms), .bound_ms = spread_ms},
      {.event = "set of several pulses", .bound_ms = wrong_ms}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    reports::RareResult& result = results[i];
    result.sets_per_day = world.scenario.trigger.pulse_rate_hz() * kSecondsPerDay;
    const bool is_spread = i == 0;
    const evaluation::RareFunction run = app::rare_sets(
        world.scenario, world.pipeline,
        is_spread ? app::RareEvent::kSpread : app::RareEvent::kWrongSet, result.bound_ms);
    const auto estimate =
        watched<evaluation::RareEstimate>([&](const evaluation::Progress& progress) {
          return evaluation::estimate_rare(run,
                                           {.bound = result.bound_ms,
                                            .seed = options.advice.first_seed,
                                            .starts = kRareStarts,
                                            .chains = kRareChains,
                                            .most_runs = is_spread ? kSpreadRuns : kWrongSetRuns,
                                            .least_probability = kLeastProbability,
                                            .jobs = options.advice.jobs,
                                            .cancel = &app::InterruptHandler::flag()},
                                           progress);
        });
    if (!estimate) return std::nullopt;
    result.estimate = *estimate;
  }
  return results;
}

void check_rare_options(const AdviseOptions& options) {
  if (options.per_day || (!options.bound_ms && options.pipeline.empty())) return;
  throw scenarios::InputError(fmt::format("{}: found without --per-day, which it is about",
                                          options.bound_ms ? "--bound-ms" : "--pipeline"));
}

void check_hosts_option(const AdviseOptions& options) {
  if (options.hosts.empty() || !evaluation::camera_of(options.request.rig).is_host) return;
  throw scenarios::InputError(
      fmt::format("--hosts: found '{}', but each {} is a host of its own; leave it out",
                  scenarios::shown_text(options.hosts), options.request.rig.camera));
}

std::string advice_text(const evaluation::Advice& advice, const std::optional<RareWorld>& world,
                        const std::optional<std::vector<reports::RareResult>>& rare,
                        const std::string& format) {
  if (format == "json") {
    reports::Json root = reports::advice_json(advice);
    if (rare) root["rare"] = reports::rare_json(*rare);
    return reports::file_text(root);
  }
  reports::Document document = reports::advice_document(advice);
  if (rare) {
    document.blocks.insert(document.blocks.begin(),
                           reports::rare_block(fmt::format("How often it goes wrong: {} with {}",
                                                           world->rig, world->pipeline),
                                               *rare));
  }
  return reports::drawn_as(format, document);
}

int advise(AdviseOptions options) {
  check_rare_options(options);
  options.request.requirements = evaluation::parse_requirements(options.require);
  evaluation::RigRequest& rig = options.request.rig;
  set_hosts(options.hosts, rig);
  add_parts(options.parts, rig);
  check_hosts_option(options);
  if (const auto exposure_ms = evaluation::exposure_ms_of(options.request.requirements)) {
    rig.sets.push_back({"/cameras/exposure_ms", fmt::format("{}", *exposure_ms)});
  }
  for (scenarios::Override& set : overrides_of(options.sets)) rig.sets.push_back(std::move(set));
  const auto advice = watched<evaluation::Advice>(
      [&](const evaluation::Progress& progress) {
        return evaluation::advise(options.request, app::simulated_world, options.advice, progress);
      },
      {.unit = "step"});
  if (!advice) return kInterrupted;
  std::optional<RareWorld> world;
  std::optional<std::vector<reports::RareResult>> rare;
  if (options.per_day) world = rare_world(*advice, options.pipeline);
  if (world) {
    rare = rare_results(options, *world);
    if (!rare) return kInterrupted;
  }
  print_result_in(options.format, [&](const std::string& format) {
    return advice_text(*advice, world, rare, format);
  });
  return kOk;
}

}  // namespace

void add_advise_command(CommandLine& line) {
  auto options = std::make_shared<AdviseOptions>();
  evaluation::RigRequest& rig = options->request.rig;
  Command command(line, "advise",
                  "Which rigs of real parts meet a requirement, the cheapest first");
  command
      .texts("--require", "METRIC<VALUE", options->require,
             "What the rig must do, repeatable: 'amd<0.1ms', 'error<50us', 'recall>99%',\n"
             "'host_error<10us', ..., or what the task tolerates: '5mm at 2m/s' (5 mm of\n"
             "movement within a set), '5mm at 2m/s exposed 1ms'. All must hold at once")
      .required();
  command
      .whole_number("--cameras", "N", rig.cameras, 1, evaluation::kMostAdviceCameras,
                    "Cameras of the rig")
      .required();
  command.text("--camera", "PART", rig.camera,
               "Which cameras: d455 (triggered), or gige_ace, oak_4 or raspberry_camera_v3\n"
               "(steered, each a host of its own). Default: d455");
  command.number("--rate", "HZ", rig.rate_hz, 1, 1000, "Frames a second. Default: 30");
  command.text("--hosts", "FEWEST..MOST", options->hosts,
               "How many hosts to try, as in 2..8 or 4. Default: 1..8");
  command.texts("--parts", "FILE", options->parts,
                "A part of your own, repeatable: a file as those of `simbench list parts`");
  command.flag("--per-day", options->per_day,
               "How often a set of the recommended rig goes wrong, down to once in a million,\n"
               "by importance splitting: up to 11600 simulated runs, some minutes");
  command.number("--bound-ms", "MS", options->bound_ms, 1e-6, 1e6,
                 "With --per-day: the spread of a set that counts as wrong. Default: the required\n"
                 "AMD, else gathering's interval");
  command.text("--pipeline", "NAME", options->pipeline,
               "With --per-day: another pipeline than the recommended one");
  command.sets(options->sets);
  command.count("--seeds", options->advice.seeds,
                "Simulated rigs behind an answer. Default: 72, so that all of them meeting it\n"
                "means a probability of at least 95 %");
  command.seed("--first-seed", options->advice.first_seed, "The first seed. Default: 1");
  command.jobs(options->advice.jobs);
  command.format(options->format, {"table", "markdown", "json"});
  command.footer(kAdviseExamples);
  command.runs([options] { return advise(*options); });
}

}  // namespace simbench::cli
