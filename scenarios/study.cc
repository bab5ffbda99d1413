#include "scenarios/study.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/scenario_json.h"

namespace simbench::scenarios {

using nlohmann::json;

namespace {

std::optional<std::uint64_t> number_in(const json& study, const char* key) {
  return study.contains(key) ? std::optional(study.at(key).get<std::uint64_t>()) : std::nullopt;
}

}  // namespace

const std::vector<Study>& studies() {
  static const std::vector<Study> all = [] {
    std::vector<Study> studies;
    for (const BuiltinFile& file : study_files()) {
      const json in = json::parse(file.text);
      studies.push_back({.name = std::string(file.name),
                         .summary = in.at("summary"),
                         .scenario = in.at("scenario"),
                         .set = in.at("set"),
                         .sweep = in.at("sweep"),
                         .pipelines = in.at("pipelines"),
                         .seeds = in.at("seeds"),
                         .tables = in.at("tables"),
                         .clocks = in.value("clocks", false),
                         .duration_s = number_in(in, "duration_s"),
                         .from_s = number_in(in, "from_s")});
    }
    return studies;
  }();
  return all;
}

const Study* find_study(std::string_view name) {
  const std::vector<Study>& all = studies();
  const auto found = std::ranges::find(all, name, &Study::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace simbench::scenarios
