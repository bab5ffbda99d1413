#include "scenarios/scenario_json.h"

#include "algorithms/ports/stage.h"

namespace simbench::scenarios {

void to_json(nlohmann::json& out, const Pipeline& pipeline) {
  out = {{"name", pipeline.name}};
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& name = at_stage(pipeline, stage.id);
    if (!stage.may_be_absent || !name.empty()) out[stage.name] = name;
  }
  if (pipeline.programs) out["host_sync"] = {{"program", *pipeline.programs}};
}
void from_json(const nlohmann::json& in, Pipeline& pipeline) {
  in.at("name").get_to(pipeline.name);
  for (const StageInfo& stage : kPipelineStages) {
    if (stage.id == PipelineStage::kHostSync) continue;
    at_stage(pipeline, stage.id) =
        stage.may_be_absent ? in.value(stage.name, "") : in.at(stage.name).get<std::string>();
  }
  const nlohmann::json& host_sync = in.at("host_sync");
  if (host_sync.is_string()) {
    host_sync.get_to(pipeline.host_sync);
    pipeline.programs.reset();
  } else {
    pipeline.programs = host_sync.at("program").get<HostPrograms>();
    pipeline.host_sync = "program " + program_name(pipeline.programs->slave.front());
  }
}

namespace {

// Calls visit(key, member) for every section.
template <class AnyScenario, class Visit>
void for_each_section(AnyScenario& scenario, Visit visit) {
  visit("name", scenario.name);
  visit("summary", scenario.summary);
  visit("timeline", scenario.timeline);
  visit("hosts", scenario.hosts);
  visit("network", scenario.network);
  visit("trigger", scenario.trigger);
  visit("cameras", scenario.cameras);
  visit("usb", scenario.usb);
  visit("faults", scenario.faults);
  visit("evaluation", scenario.evaluation);
  visit("algorithms", scenario.algorithms);
  visit("pipelines", scenario.pipelines);
  visit("published", scenario.published);
  visit("published_figures", scenario.published_figures);
  visit("fitted_to", scenario.fitted_to);
  visit("studio", scenario.studio);
}

}  // namespace

void to_json(nlohmann::json& out, const Scenario& scenario) {
  out = nlohmann::json::object();
  for_each_section(scenario, [&out](const char* key, const auto& section) { out[key] = section; });
}

void from_json(const nlohmann::json& in, Scenario& scenario) {
  for_each_section(scenario,
                   [&in](const char* key, auto& section) { read_if_there(in, key, section); });
}

}  // namespace simbench::scenarios
