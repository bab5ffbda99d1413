#include "explore/explorer.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "explore/measured.h"
#include "explore/parameters.h"
#include "recording/version.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure.h"
#include "reports/page/explore_page.h"
#include "scenarios/loader.h"

namespace simbench::explore {
namespace {

using reports::Json;
using server::PageRequest;
using server::PageResponse;

constexpr const char* kJson = "application/json";

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PageResponse refusal(const StateRefused& refused) {
  return {.status = 422,
          .type = kJson,
          .body = text_of({{"pointer", refused.pointer()}, {"message", refused.what()}})};
}

std::uint64_t seeds_in(const Json& body) {
  const auto found = body.find("seeds");
  const bool is_there = found != body.end() && found->is_number_unsigned();
  return is_there ? std::clamp<std::uint64_t>(*found, 1, kMostSeeds) : kFirstSeeds;
}

Json figures_json() {
  Json figures = Json::array();
  for (const reports::FigureEntry& entry : reports::figure_catalogue()) {
    const bool is_of_a_run =
        entry.scope == reports::FigureScope::kRun || entry.scope == reports::FigureScope::kSeed;
    if (is_of_a_run) figures.push_back({{"id", entry.id}, {"title", entry.title}});
  }
  return figures;
}

}  // namespace

Explorer::Explorer(PageSubject subject) : subject_(std::move(subject)), looks_(subject_) {}

PageResponse Explorer::answer(const PageRequest& request) {
  if (request.path.empty()) {
    return {.type = "text/html; charset=utf-8", .body = reports::explore_html()};
  }
  if (request.path == "subject") return subject_response();
  if (request.method != "POST") return {.status = 404, .body = "there is no such page\n"};
  try {
    const Json body = Json::parse(request.body);
    if (request.path == "look") return look(body);
    return made_of(request.path, body);
  } catch (const Json::exception&) {
    return refusal({"", "the page sent what is no JSON, or of another form"});
  } catch (const StateRefused& refused) {
    return refusal(refused);
  }
}

PageResponse Explorer::subject_response() const {
  Json scenarios = Json::array();
  for (const scenarios::BuiltinScenario& each : scenarios::builtin_scenarios()) {
    scenarios.push_back({{"name", each.name}, {"summary", each.summary}});
  }
  return {.type = kJson,
          .body = text_of({{"subject", subject_.name},
                           {"pipelines", subject_.pipelines},
                           {"first_seed", subject_.first_seed},
                           {"measured", subject_.measured ? subject_.measured->panel : Json()},
                           {"scenarios", std::move(scenarios)},
                           {"figures", figures_json()},
                           {"first_seeds", kFirstSeeds},
                           {"most_seeds", kMostSeeds},
                           {"version", std::string(version())}})};
}

PageResponse Explorer::made_of(const std::string& path, const Json& body) const {
  const State state = state_of(body.at("state"), subject_);
  if (path == "parameters") {
    const scenarios::Scenario world = world_of({.scenario = state.scenario}, subject_);
    return {.type = kJson,
            .body = text_of(
                {{"parameters", parameters_json(world)}, {"choices", pipelines_json(world)}})};
  }
  if (path == "scenario.json") {
    return {.type = kJson, .body = file_of(state, subject_), .file_name = "explored.json"};
  }
  if (path == "command.txt") {
    return {.body = reports::shell_line(command_of(state, subject_, seeds_in(body))) + "\n"};
  }
  if (path == "script.py") {
    return {.type = "text/x-python",
            .body = python_of(state, subject_, seeds_in(body)),
            .file_name = "explored.py"};
  }
  return {.status = 404, .body = "there is no such page\n"};
}

PageResponse Explorer::look(const Json& body) {
  LookRequest request = request_of(body, subject_);
  const bool is_text = !request.format.empty();
  if (is_text) world_of(request.states.front(), subject_);  // refuses before the answer's head
  return {
      .type = is_text ? "text/plain; charset=utf-8" : "application/x-ndjson",
      .stream = [this, request = std::move(request)](std::shared_ptr<server::PageStream> stream) {
        looks_.add(request, std::move(stream));
      }};
}

}  // namespace simbench::explore
