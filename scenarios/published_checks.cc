#include "scenarios/published_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

// `what`: "no such pipeline", or with its name where the pointer does not have it.
void check_is_pipeline(const Scenario& scenario, const std::string& pointer,
                       const std::string& name, const std::string& what) {
  std::vector<std::string> pipelines;
  for (const Pipeline& pipeline : scenario.pipelines) pipelines.push_back(pipeline.name);
  if (std::ranges::find(pipelines, name) != pipelines.end()) return;
  const std::vector<std::string> similar = nearest(name, pipelines);
  fail_at(scenario, pointer,
          similar.empty()
              ? fmt::format("found {}, allowed {}", what, fmt::join(pipelines, ", "))
              : fmt::format("found {}, did you mean {}?", what, fmt::join(similar, " or ")));
}

template <class Result>
void check_published_results(const Scenario& scenario, const std::string& pointer,
                             const std::map<std::string, Result>& published) {
  for (const auto& [name, result] : published) {
    check_is_pipeline(scenario, child_pointer(pointer, name), name, "no such pipeline");
  }
}

void check_has_one_number(const Scenario& scenario, const std::string& pointer,
                          const PublishedFigure& figure) {
  std::vector<std::string> stated;
  if (figure.at_most) stated.emplace_back("at_most");
  if (figure.value) stated.emplace_back("value");
  if (figure.at_least) stated.emplace_back("at_least");
  if (stated.size() == 1) return;
  fail_at(
      scenario, pointer,
      fmt::format("found {}, allowed exactly one of at_most, value and at_least",
                  stated.empty() ? "none of them" : fmt::format("{}", fmt::join(stated, ", "))));
}

}  // namespace

void check_published(const Scenario& scenario) {
  check_published_results(scenario, "/published", scenario.published);
  if (scenario.studio) {
    check_published_results(scenario, "/studio/published", scenario.studio->published);
  }
  for (std::size_t i = 0; i < scenario.published_figures.size(); ++i) {
    const PublishedFigure& figure = scenario.published_figures[i];
    const std::string pointer = fmt::format("/published_figures/{}", i);
    check_is_pipeline(scenario, pointer + "/pipeline", figure.pipeline,
                      fmt::format("\"{}\"", shown_text(figure.pipeline)));
    check_has_one_number(scenario, pointer, figure);
  }
}

}  // namespace simbench::scenarios
