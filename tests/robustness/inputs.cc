#include "tests/robustness/inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "scenarios/loader.h"
#include "tests/data/file_forms.h"
#include "tests/data/ibl_recordings.h"
#include "tests/robustness/child.h"
#include "tests/robustness/mutation.h"
#include "tests/scratch_folder.h"

namespace simbench::robustness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGood = "good";    // the examples, which stay as they are
constexpr const char* kTried = "tried";  // their copies, which are damaged
constexpr const char* kWritten = "written";

constexpr const char* kRig = R"({
  "schema_version": 1,
  "name": "studio",
  "hosts": [
    {"name": "host0", "address": "127.0.0.1", "port": 1,
     "cameras": [{"serial": "0"}, {"serial": "1"},
                 {"serial": "2", "recording": "left.csv", "recorded_camera": "c"}]}
  ],
  "trigger": "manual"
}
)";

}  // namespace

Inputs::Inputs(std::string folder) : folder_(std::move(folder)) {
  fs::create_directories(fs::path(folder_) / kGood);
  scenarios::load_scenario("3cam_1host_30fps");  // compiles the schema, for all children
  add_files();
  add_forms();
  add_bags();
  add_archives();
  add_clock_archive();
  fs::copy(fs::path(folder_) / kGood, fs::path(folder_) / kTried, fs::copy_options::recursive);
  fs::create_directory(fs::path(folder_) / kWritten);
  check_forms();
  add_arguments();
}

// A mutant of what is refused anyway finds little.
void Inputs::check_forms() const {
  for (const Kind& kind : kinds_) {
    if (!kind.name.starts_with("forms/")) continue;
    const Ending ending = call({.arguments = resolved(kind.commands.front(), "")});
    if (ending.status != 0) {
      throw std::runtime_error(fmt::format("{}: {}", kind.name, ending.messages));
    }
  }
}

void Inputs::copy(const std::string& from, const std::string& to) const {
  const fs::path target = fs::path(folder_) / kGood / to;
  fs::create_directories(target.parent_path());
  fs::copy_file(fs::path(SIMBENCH_SOURCE_DIR) / from, target);
}

void Inputs::make(const std::vector<std::string>& arguments) const {
  Call made{.arguments = {"simbench"}};
  for (std::string argument : arguments) {
    if (argument.starts_with('@')) argument = folder_ + "/" + kGood + argument.substr(1);
    made.arguments.push_back(argument);
  }
  const Ending ending = call(made);
  if (ending.status != 0) {
    throw std::runtime_error(
        fmt::format("{}: {}", fmt::join(made.arguments, " "), ending.messages));
  }
}

std::vector<std::string> Inputs::files_of(const std::string& below) const {
  const fs::path good = fs::path(folder_) / kGood;
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(good / below)) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(good));
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw std::runtime_error("no examples in " + below);
  return files;
}

// Files that people write or that other programs have written.
void Inputs::add_files() {
  for (const auto& entry : fs::directory_iterator(fs::path(SIMBENCH_SOURCE_DIR) / "scenarios")) {
    const std::string name = entry.path().filename();
    if (!name.ends_with(".json") || name == "schema.json") continue;
    copy("scenarios/" + name, "scenario/" + name);
  }
  add({"scenario", 6, files_of("scenario"), {{"validate", "%"}, {"describe", "%"}}});

  fs::create_directories(fs::path(folder_) / kGood / "ibl");
  const std::string ibl = folder_ + "/" + kGood + "/ibl/";
  put(ibl + "body.timestamps.ssv", ibl_timestamps({.frames = 100}));
  put(ibl + "left.frameData.bin", ibl_frame_data({.frames = 100}));
  add({"ibl", 4, files_of("ibl"), {{"convert-ibl", "%"}}});

  fs::create_directories(fs::path(folder_) / kGood / "rig");
  put(folder_ + "/" + kGood + "/rig/rig.json", kRig);
  add({"rig",
       1,
       files_of("rig"),
       {{"record", "--backend", "hardware", "--scenario", "3cam_1host_30fps", "--pipelines",
         "genlock", "--rig", "%", "--output", "@written/recording"}}});
}

// Logs, tables and lists of stamps in every form that docs/files.md has, by that page's commands.
void Inputs::add_forms() {
  const fs::path folder = fs::path(folder_) / kGood / "forms";
  for (const auto& [name, text] : file_forms()) {
    fs::create_directories((folder / name).parent_path());
    put(folder / name, text);
  }
  for (std::vector<std::string> command : commands_of_files_page()) {
    std::vector<std::string> files;
    for (std::size_t i = 1; i < command.size(); ++i) {
      const fs::path input = folder / command[i];
      if (!fs::exists(input)) continue;
      const std::string name = "forms/" + command[i];
      const std::vector<std::string> of_folder =
          fs::is_directory(input) ? files_of(name) : std::vector<std::string>{name};
      files.insert(files.end(), of_folder.begin(), of_folder.end());
      command[i] = "@tried/" + name;
    }
    // A bag and a video are no text.
    if (!files.empty()) add({files.front(), 1, files, {command}});
  }
}

void Inputs::add_bags() {
  for (const char* format : {"mcap", "rosbag", "sqlite_bag"}) {
    const fs::path corpus = fs::path(SIMBENCH_SOURCE_DIR) / "tests/fuzz/corpus" / format;
    for (const auto& entry : fs::directory_iterator(corpus)) {
      const std::string name = entry.path().filename();
      if (name != "cut")
        copy(fmt::format("tests/fuzz/corpus/{}/{}", format, name),
             fmt::format("{}/{}", format, name));
    }
    add({format,
         2,
         files_of(format),
         {{"inspect", "%"}, {"inspect", "%", "--format", "json"}, {"diagnose", "%"}}});
  }
}

// Folders that simbench has written.
void Inputs::add_archives() {
  const std::vector<std::string> world = {
      "--scenario", "3cam_1host_30fps",         "--set",       "/timeline/frames=20",
      "--set",      "/timeline/warm_up_ms=100", "--pipelines", "genlock,regression_offline"};
  const auto with_world = [&](std::vector<std::string> first) {
    first.insert(first.end(), world.begin(), world.end());
    return first;
  };
  make(with_world({"record", "--output", "@/recording"}));
  add({"recording",
       6,
       files_of("recording"),
       {{"replay", "@tried/recording", "--format", "json"},
        {"fit", "@tried/recording", "--output", "@written/fit.json"}}});

  fs::create_directories(fs::path(folder_) / kGood / "csv");
  for (int camera = 0; camera < 2; ++camera) {
    std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
    for (int frame = 0; frame < 40; ++frame) {
      const double late = 0.1 * ((frame * 7 + camera * 3) % 5);
      text += fmt::format("Depth,0,{},{:.3f},{:.3f}\n", frame + 1, 1000 * camera + 33.333 * frame,
                          5 + 33.334 * frame + late);
    }
    put(fmt::format("{}/{}/csv/camera{}.csv", folder_, kGood, camera), text);
  }
  const std::string first = "@tried/csv/camera0.csv";
  const std::string second = "@tried/csv/camera1.csv";
  add({"csv",
       8,
       files_of("csv"),
       {{"replay", first, second, "--format", "json"},
        {"replay", first, second},
        {"diagnose", first, second},
        {"fit", first, second, "--output", "@written/fit.json"}}});

  make(with_world({"run", "--seeds", "2", "--jobs", "1", "--output", "@/archive"}));
  add({"archive",
       4,
       files_of("archive"),
       {{"compare", "@tried/archive"},
        {"compare", "@tried/archive", "@good/archive", "--format", "json"},
        {"report", "@tried/archive", "--budget-seeds", "0", "--seeds-in-detail", "1", "--output",
         "@written/report.html"},
        {"figure", "distributions", "@tried/archive", "--output", "@written/figure.csv"}}});
  make({"gate", "@/archive", "--save-baseline", "@/baseline.json"});
  add({"baseline",
       4,
       {"baseline.json"},
       {{"gate", "@good/archive", "--baseline", "%"},
        {"gate", "@good/archive", "--baseline", "%", "--mode", "statistical", "--format", "junit"},
        {"gate", "@good/archive", "--baseline", "%", "--format", "markdown"}}});

  const std::vector<std::string> sweep = with_world(
      {"sweep", "--sweep", "/trigger/rate_hz=15,30", "--seeds", "1", "--jobs", "1", "--output"});
  std::vector<std::string> made = sweep;
  made.insert(std::find(made.begin(), made.end(), "--output") + 1, "@/sweep");
  make(made);
  std::vector<std::string> continued = sweep;
  continued.insert(std::find(continued.begin(), continued.end(), "--output") + 1, "@tried/sweep");
  add({"sweep", 1, files_of("sweep"), {continued}});
}

void Inputs::add_clock_archive() {
  make({"clocks", "--scenario", "6host_star", "--duration-s", "400", "--from-s", "100", "--seeds",
        "2", "--jobs", "1", "--pipelines", "chrony,oracle", "--output", "@/clocks"});
  add({"clocks",
       2,
       {"clocks/manifest.json", "clocks/results.json"},
       {{"compare", "@tried/clocks", "--with-baseline", "oracle"},
        {"compare", "@tried/clocks", "@good/clocks", "--format", "json"},
        {"report", "@tried/clocks", "--output", "@written/report.html"}}});
}

void Inputs::add_arguments() {
  add({"arguments",
       4,
       {},
       {{"describe", "18cam_6host_45fps", "--set", "/trigger/rate_hz=30"},
        {"describe", "18cam_6host_45fps_lan", "--set", "/algorithms/ntp/min_poll=4"},
        {"describe", "3cam_1host_30fps", "/cameras", "--set", "/cameras/streams/0/width=640"},
        {"describe", "two_way_hull", "--format", "json"},
        {"code", "18cam_6host_90fps_coded", "--set", "/trigger/code/order=6"},
        {"describe", "3cam_1host_30fps", "--set", "/faults=[{\"kind\": \"clock_step\"}]"},
        {"run", "--scenario", "3cam_1host_30fps", "--seeds", "1", "--jobs", "1", "--set",
         "/timeline/frames=10", "--format", "csv", "--pipelines", "genlock,oracle"},
        {"3cam_1host_30fps", "--seeds", "1", "--jobs", "1", "--set", "/timeline/frames=10",
         "--format", "tidy", "--pipelines", "oracle+hull_300+genlock"},
        {"sweep", "--scenario", "3cam_1host_30fps", "--sweep", "/trigger/rate_hz=15:30:5", "--set",
         "/timeline/frames=5", "--seeds", "1", "--jobs", "1"},
        {"clocks", "--scenario", "6host_star", "--duration-s", "400", "--from-s", "100", "--seeds",
         "1", "--jobs", "1", "--pipelines", "chrony,free_running", "--format", "json"},
        {"trace", "--scenario", "3cam_1host_30fps", "--set", "/timeline/frames=5", "--pipeline",
         "genlock", "--seed", "3", "--format", "csv", "--output", "@written/trace.csv"},
        {"paper", "--seeds", "0", "--jobs", "1", "--no-table-4", "--format", "json"},
        {"diagnose", "@good/csv/camera0.csv", "@good/csv/camera1.csv", "--rate-hz", "30"},
        {"compare", "@good/archive", "--with-baseline", "genlock", "--smallest-effect", "5"},
        {"gate", "@good/archive", "--baseline", "@good/baseline.json", "--mode", "exact"},
        {"figure", "distributions", "@good/archive", "--output", "@written/figure.csv"},
        {"list", "pipelines", "--format", "json"},
        {"completion", "bash"},
        {"manual", "run"}}});
}

std::vector<std::string> Inputs::resolved(std::vector<std::string> command,
                                          const std::string& file) const {
  for (std::string& argument : command) {
    if (argument == "%") argument = folder_ + "/" + kTried + "/" + file;
    if (argument.starts_with('@')) argument = folder_ + "/" + argument.substr(1);
  }
  command.insert(command.begin(), "simbench");
  return command;
}

const Inputs::Kind& Inputs::any_kind(Random& random) const {
  std::size_t shares = 0;
  for (const Kind& kind : kinds_) shares += kind.share;
  std::size_t place = random.below(shares);
  const Kind* chosen = kinds_.data();
  while (place >= chosen->share) place -= (chosen++)->share;
  return *chosen;
}

Attempt Inputs::undamaged(Random& random) const {
  const Kind& kind = any_kind(random);
  const std::string file = kind.files.empty() ? "" : random.of(kind.files);
  return {kind.name, resolved(random.of(kind.commands), file), "", ""};
}

Attempt Inputs::next(Random& random) {
  const Kind& kind = any_kind(random);
  Attempt attempt{.kind = kind.name, .arguments = {}, .file = {}, .input = {}};
  if (kind.files.empty()) {
    attempt.arguments = resolved(random.of(kind.commands), "");
    std::string& damaged = attempt.arguments[1 + random.below(attempt.arguments.size() - 1)];
    // What is written stays in the folder.
    if (damaged.find(kWritten) == std::string::npos) damaged = mutated(damaged, random);
    attempt.input = damaged;
    return attempt;
  }
  attempt.file = random.of(kind.files);
  attempt.arguments = resolved(random.of(kind.commands), attempt.file);
  attempt.input = mutated(content(folder_ + "/" + kGood + "/" + attempt.file), random);
  put(folder_ + "/" + kTried + "/" + attempt.file, attempt.input);
  return attempt;
}

void Inputs::restore(const Attempt& attempt) {
  const fs::path folder = folder_;
  for (const auto& entry : fs::directory_iterator(folder / kWritten)) fs::remove_all(entry.path());
  if (attempt.kind == "sweep") {  // which its command continues
    fs::remove_all(folder / kTried / "sweep");
    fs::copy(folder / kGood / "sweep", folder / kTried / "sweep", fs::copy_options::recursive);
  } else if (!attempt.file.empty()) {
    fs::copy_file(folder / kGood / attempt.file, folder / kTried / attempt.file,
                  fs::copy_options::overwrite_existing);
  }
}

}  // namespace simbench::robustness
