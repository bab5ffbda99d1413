#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/results/csv.h"
#include "reports/sweep/sweep_report.h"

namespace simbench::reports {
namespace {

using evaluation::SweepPlan;
using evaluation::SweepRun;
using evaluation::SweepScore;
using Json = nlohmann::ordered_json;

// The columns that say which run it is.
std::string run_header(const SweepPlan& plan) {
  std::string header;
  for (const std::string& pointer : plan.pointers()) header.append(csv_cell(pointer)).append(",");
  return header + "pipeline,seed";
}

std::string run_cells(const SweepPlan& plan, const SweepRun& run) {
  std::string cells;
  for (const std::string& value : plan.values(run.point)) cells.append(csv_cell(value)).append(",");
  return cells + fmt::format("{},{}", csv_cell(plan.pipelines[run.pipeline]), run.seed);
}

// A value of an axis: a number where it is one, else a word.
Json value_of(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_discarded() ? Json(text) : value;
}

}  // namespace

std::string sweep_manifest(const SweepPlan& plan, const std::string& study) {
  Json axes = Json::array();
  for (const evaluation::SweepAxis& axis : plan.axes) {
    Json pointers = Json::object();
    for (std::size_t i = 0; i < axis.pointers.size(); ++i) {
      Json& values = pointers[axis.pointers[i]] = Json::array();
      for (const std::string& value : axis.values[i]) values.push_back(value_of(value));
    }
    axes.push_back(std::move(pointers));
  }
  Json manifest = {{"schema_version", 1},
                   {"program", "simbench"},
                   {"kind", "sweep"},
                   {"version", version()},
                   {"commit", commit()}};
  if (!study.empty()) manifest["study"] = study;
  manifest["axes"] = std::move(axes);
  manifest["pipelines"] = plan.pipelines;
  manifest["seeds"] = {{"first", plan.first_seed}, {"count", plan.seeds}};
  manifest["scenario"] = Json::parse(plan.scenario_json);
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string sweep_csv(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  std::string csv = run_header(plan);
  for (const evaluation::Metric* metric : evaluation::sweep_metrics()) {
    csv.append(",").append(metric->sweep);
  }
  csv += '\n';
  for (std::size_t index = 0; index < scores.size(); ++index) {
    csv += run_cells(plan, plan.run(index));
    for (const double value : scores[index].values) csv.append(",").append(csv_cell(value));
    csv += '\n';
  }
  return csv;
}

std::string sweep_hosts_csv(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  std::string csv = run_header(plan) + ",host,error_ms\n";
  for (std::size_t index = 0; index < scores.size(); ++index) {
    const std::string cells = run_cells(plan, plan.run(index));
    const std::vector<double>& errors = scores[index].host_errors_ms;
    for (std::size_t host = 0; host < errors.size(); ++host) {
      csv += fmt::format("{},{},{}\n", cells, host, csv_cell(errors[host]));
    }
  }
  return csv;
}

}  // namespace simbench::reports
