#include "reports/archive/archive.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/results/csv.h"
#include "reports/results/json.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;

std::string utc_text(std::chrono::system_clock::time_point time) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(time - whole).count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(whole)), ms);
}

}  // namespace

std::string manifest_json(const Provenance& provenance, const std::string& more) {
  Json manifest = {{"schema_version", 1},
                   {"program", "simbench"},
                   {"version", version()},
                   {"commit", commit()},
                   {"command", provenance.command},
                   {"started", utc_text(provenance.started)},
                   {"finished", utc_text(provenance.finished)}};
  manifest.update(Json::parse(more));
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_archive(OutputFolder& output, const evaluation::Results& results,
                   const scenarios::Scenario& scenario, const Provenance& provenance) {
  Json more = {{"seeds", {{"first", results.first_seed}, {"count", results.seed_count}}},
               {"pipelines", Json::array()},
               {"scenario", Json::parse(scenario.resolved_json)}};
  for (const evaluation::Row& row : results.rows) more["pipelines"].push_back(row.pipeline);
  output.file("manifest.json") << manifest_json(provenance, more.dump());
  output.file("results.json") << json(results);
  write_frames_csv(results, output.file("frames.csv"));
  write_hosts_csv(results, output.file("hosts.csv"));
  output.publish();
}

}  // namespace simbench::reports
