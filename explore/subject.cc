#include "explore/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <utility>

#include "app/recordings.h"
#include "explore/measured.h"
#include "recording/collected.h"
#include "reports/archive/archive.h"
#include "scenarios/document.h"

namespace simbench::explore {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFittedName = "fitted.json";

// The recording that the file was fitted to, if it names one that is there.
void add_recording(const scenarios::Scenario& scenario, const SubjectChoice& choice,
                   const ReadProgress& progress, FoundSubject& found) {
  if (scenario.fitted_to.empty()) return;
  const fs::path folder = fs::path(found.subject.name).parent_path();
  std::vector<std::string> inputs;
  for (const std::string& path : scenario.fitted_to) {
    const fs::path full = fs::path(path).is_absolute() ? fs::path(path) : folder / path;
    if (!fs::exists(full)) {
      found.notes.push_back(fmt::format(
          "{} was fitted to {}, which is not there: nothing measured is shown beside it",
          found.subject.name, full.string()));
      return;
    }
    inputs.push_back(full.string());
  }
  try {
    found.subject.measured = std::make_shared<const Measured>(
        measured(inputs, found.subject.name, choice.files, progress));
  } catch (const std::exception& failure) {
    found.notes.push_back(
        fmt::format("nothing measured is shown beside {}: {}", found.subject.name, failure.what()));
  }
}

FoundSubject scenario_subject(const std::string& name, const SubjectChoice& choice,
                              const ReadProgress& progress) {
  FoundSubject found{.subject = {.name = name, .sets = choice.sets}};
  const scenarios::Scenario scenario = scenarios::load_scenario(name, choice.sets);
  if (is_builtin_scenario(name)) return found;
  found.subject.text = scenarios::read_input_file(name, name, "scenario");
  add_recording(scenario, choice, progress, found);
  return found;
}

FoundSubject archive_subject(const std::string& path, const SubjectChoice& choice) {
  const reports::Archive archive = reports::read_archive(path);
  if (archive.scenario_json.empty() || reports::is_of_files(archive)) {
    throw scenarios::InputError(fmt::format(
        "{}: found results without a world, allowed: the archive of `simbench run`, a scenario or "
        "the recording itself",
        path));
  }
  PageSubject subject{.name = path,
                      .text = archive.scenario_json,
                      .sets = choice.sets,
                      .first_seed = archive.results.first_seed};
  for (const evaluation::Row& row : archive.results.rows) {
    if (!row.is_of_programs) subject.pipelines.push_back(row.pipeline);
  }
  return {.subject = std::move(subject)};
}

FoundSubject recording_subject(const std::vector<std::string>& inputs, const SubjectChoice& choice,
                               const ReadProgress& progress) {
  auto rig =
      std::make_shared<const Measured>(measured(inputs, kFittedName, choice.files, progress));
  PageSubject subject{
      .name = kFittedName, .text = rig->model, .sets = choice.sets, .measured = rig};
  return {.subject = std::move(subject)};
}

}  // namespace

FoundSubject subject_of(const std::vector<std::string>& inputs, const SubjectChoice& choice,
                        const ReadProgress& progress) {
  const std::string& first = inputs.front();
  const bool is_one = inputs.size() == 1;
  const bool is_folder = fs::is_directory(first);
  if (is_one && (is_builtin_scenario(first) || (first.ends_with(".json") && !is_folder))) {
    return scenario_subject(first, choice, progress);
  }
  if (is_one && is_folder && !app::is_recording_folder(first) &&
      fs::exists(fs::path(first) / "results.json")) {
    return archive_subject(first, choice);
  }
  if (is_one && !fs::exists(first)) {
    scenarios::load_scenario(first);  // refuses it, with names like it
  }
  return recording_subject(inputs, choice, progress);
}

}  // namespace simbench::explore
