#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/interrupt.h"
#include "cli/command.h"
#include "cli/command_line.h"
#include "cli/commands/commands.h"
#include "cli/process.h"
#include "cli/progress.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/pipeline_choice.h"
#include "reconstruction/experiment.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/reconstruction/reconstruction_folder.h"

namespace simbench::cli {
namespace {

using reconstruction::ReconstructionResults;

constexpr const char* kExamples = R"(
Simulates depth cameras around a moving subject, each of which exposes at the instant that its
synchronisation gives it. Fuses their depth maps to a mesh and compares the mesh with the depth
maps. Needs a simbench with Embree and Open3D (tools/run --with-reconstruction) and a scenario with
a studio.

Examples:
  simbench reconstruct --scenario 18cam_6host_30fps_studio
  simbench reconstruct --scenario 18cam_6host_30fps_studio -o results/table4
  simbench reconstruct --scenario 18cam_6host_30fps_studio --pipelines ntp_last_set,yoon2021_both
                       --frames 10 --seeds 3 --no-curve
  simbench reconstruct --scenario 18cam_6host_30fps_studio --motion turn --speed-factors 1,2,3
  simbench reconstruct --scenario 18cam_6host_30fps_studio --mesh statue.ply --format json

In the folder: table.txt, results.json, scenario.json, report.html; for each pipeline a mesh (.ply)
painted with its errors, and its picture (.png); curve.csv and curve.svg (drawn by gnuplot).

Exit status: 0 ok, 1 internal error, 2 bad usage or input, or built without the libraries,
130 interrupted.)";

// Factors on the script's speeds, tried in the search for the published error.
const std::vector<double> kSearchedFactors = {0.25, 0.5, 1.5, 2, 3};
constexpr double kMostSpeedFactor = 20;
constexpr double kMostDesyncMs = 10'000;

struct ReconstructOptions {
  std::string scenario;
  reconstruction::ReconstructionOptions reconstruction;
  std::vector<std::string> sets;
  std::string mesh;
  std::string motion;
  std::vector<double> speed_factors = {0.5, 1, 1.5};
  std::vector<double> desync_ms = {0, 5, 10, 20, 33, 50, 100, 200, 500};
  bool no_curve = false;
  std::string format;
  std::string output;
  std::vector<std::string> command;
  const reconstruction::Reconstruction* reconstruction_part = nullptr;
};

[[noreturn]] void become_reconstruct_program(std::vector<std::string> arguments) {
  const int reason = become_sibling("simbench-reconstruct", std::move(arguments));
  throw scenarios::InputError(
      fmt::format("reconstruction needs Embree and Open3D, and this simbench was built without "
                  "them (no simbench-reconstruct beside it: {}). tools/run --with-reconstruction "
                  "installs them and builds with them (Debian: libembree-dev libopen3d-dev; CMake: "
                  "-DSIMBENCH_WITH_RECONSTRUCTION=ON)",
                  std::strerror(reason)));
}

// The options of the subject are short for --set, which overrides them.
std::vector<scenarios::Override> all_overrides(const ReconstructOptions& options) {
  std::vector<scenarios::Override> overrides;
  const auto set_text = [&](const char* pointer, const std::string& text) {
    overrides.push_back({.pointer = pointer, .value = nlohmann::json(text).dump()});
  };
  if (!options.mesh.empty()) {
    set_text("/studio/subject/kind", "mesh");
    set_text("/studio/subject/mesh_file", options.mesh);
  }
  if (!options.motion.empty()) set_text("/studio/subject/motion", options.motion);
  const std::vector<scenarios::Override> stated = overrides_of(options.sets);
  overrides.insert(overrides.end(), stated.begin(), stated.end());
  return overrides;
}

std::vector<double> in_order(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::string text_of(const ReconstructionResults& results, const std::string& format) {
  if (format == "json") return reports::reconstruction_json(results);
  if (format == "csv") return reports::reconstruction_csv(results);
  return plain(reports::reconstruction_document(results));
}

std::optional<ReconstructionResults> reconstruct(
    const reconstruction::Reconstruction& part, const scenarios::Scenario& scenario,
    const reconstruction::ReconstructionOptions& options, reports::ReconstructionFolder* folder) {
  const auto make_source = [&] { return app::simulated_world(scenario); };
  const auto on_mesh = [folder](const reconstruction::ShownMesh& mesh) {
    if (folder != nullptr) folder->keep(mesh);
  };
  return watched<ReconstructionResults>(
      [&](const evaluation::Progress& progress) {
        return part.run(scenario, make_source, options, on_mesh, progress);
      },
      {.unit = "frame set"});
}

int run_reconstruct(const ReconstructOptions& options) {
  if (options.reconstruction_part == nullptr) become_reconstruct_program(options.command);
  reports::Provenance provenance;
  provenance.command = options.command;
  provenance.started = std::chrono::system_clock::now();
  const scenarios::Scenario scenario = scenarios::load_scenario(
      options.scenario, evaluation::with_ad_hoc_pipelines(options.scenario, all_overrides(options),
                                                          options.reconstruction.pipelines));
  evaluation::check_pipelines(scenario);
  evaluation::choose_pipelines(scenario, options.reconstruction.pipelines);
  print_warnings(scenarios::warnings(scenario));
  std::optional<reports::ReconstructionFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output, scenario);

  reconstruction::ReconstructionOptions experiment = options.reconstruction;
  experiment.cancel = &app::InterruptHandler::flag();
  if (!options.no_curve) {
    experiment.curve_speed_factors = in_order(options.speed_factors);
    experiment.curve_desync_ms = in_order(options.desync_ms);
    experiment.search_speed_factors = kSearchedFactors;
  }
  const std::optional<ReconstructionResults> results =
      reconstruct(*options.reconstruction_part, scenario, experiment, folder ? &*folder : nullptr);
  if (!results) return kInterrupted;
  provenance.finished = std::chrono::system_clock::now();
  if (folder) {
    const std::string not_drawn = folder->write(*results, provenance);
    if (!not_drawn.empty()) print_warnings({not_drawn});
    print_note("results written to " + options.output);
  }
  print_result(text_of(*results, options.format));
  return kOk;
}

void add_subject_options(Command& command, ReconstructOptions& options) {
  command.text("--mesh", "FILE", options.mesh,
               "A mesh as the subject, in metres: PLY, OBJ, OFF or STL. Short for\n"
               "--set /studio/subject/kind=mesh --set /studio/subject/mesh_file=FILE");
  command.word("--motion", "NAME", options.motion, scenarios::all_texts<scenarios::MotionScript>(),
               "How the subject moves: stand, turn, walk, walk_and_turn, raise_arms. Short\n"
               "for --set /studio/subject/motion=NAME. Default: the scenario's");
}

void add_curve_options(Command& command, ReconstructOptions& options) {
  command.number("--speed-factors", "F,F", options.speed_factors, 0, kMostSpeedFactor,
                 "For the curve: factors on the scenario's speeds; the table has the resulting\n"
                 "speeds. Default: 0.5,1,1.5");
  command.number("--desync-ms", "MS,MS", options.desync_ms, 0, kMostDesyncMs,
                 "For the curve: how far apart the hosts are, in ms. Default:\n"
                 "0,5,10,20,33,50,100,200,500");
  command.flag("--no-curve", options.no_curve,
               "Only the pipelines: no curve, and no search for the speed that gives the\n"
               "published error");
}

}  // namespace

void add_reconstruct_command(CommandLine& line) {
  auto options = std::make_shared<ReconstructOptions>();
  options->command = line.arguments;
  options->reconstruction_part = line.extras.reconstruction;
  reconstruction::ReconstructionOptions& experiment = options->reconstruction;
  Command command(line, "reconstruct",
                  "Reconstruct a moving subject, and print what desynchronisation costs");
  command
      .text("--scenario", "SCENARIO", options->scenario,
            "Name of a scenario with a studio (see `simbench list`) or path of its file")
      .required();
  command.pipelines(experiment.pipelines);
  command.whole_number("--frames", "N", experiment.frames, 1, 100'000,
                       "Frame sets to reconstruct for each pipeline and seed. Default: 10");
  command.count("--seeds", experiment.seeds, "How many seeds. Default: 5");
  command.seed("--first-seed", experiment.first_seed, "The first seed. Default: 1");
  command.jobs(experiment.jobs);
  command.sets(options->sets);
  add_subject_options(command, *options);
  add_curve_options(command, *options);
  command.format(options->format, {"table", "json", "csv"});
  command.output("-o,--output", "DIR", options->output,
                 "Write everything to this folder, with meshes and pictures. Replaces an earlier\n"
                 "result there");
  command.footer(kExamples);
  command.runs([options] { return run_reconstruct(*options); });
}

}  // namespace simbench::cli
