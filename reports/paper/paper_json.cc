#include <cmath>
#include <string>

#include "reports/paper/paper_document.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/results/json.h"
#include "reports/text/json_node.h"

namespace simbench::reports {
namespace {

Json printed_json(const PrintedValue& value) {
  const evaluation::Percentile& at = value.percentile;
  return {{"pipeline", value.row->pipeline},
          {"metric", value.metric},
          {"printed", value.printed},
          {"median", evaluation::metric(value.metric).series(*value.row).median},
          {"percentile", at.percent},
          {"percentile_interval", Json::array({at.low, at.high})},
          {"attainable", value.is_attainable()},
          {"inside", inside_json(at)}};
}

Json run_json(const PaperRun& run) {
  Json printed = Json::array();
  for (const PrintedValue& value : printed_values(run)) printed.push_back(printed_json(value));
  return {{"table", run.table},
          {"rate_hz", run.scenario.trigger.rate_hz},
          {"printed", printed},
          {"not_reached", not_reached(run)},
          {"results", Json::parse(json(run.results))}};
}

Json held_json(const evaluation::Percentile& share) {
  if (!std::isfinite(share.percent)) return nullptr;
  return {{"percent", share.percent}, {"percent_interval", Json::array({share.low, share.high})}};
}

Json paper_claim_json(const PaperClaim& claim) {
  return {{"id", claim.id},
          {"text", claim.text},
          {"printed", claim.printed ? Json(*claim.printed) : Json()},
          {"at_15_fps", held_json(claim.at_15_fps)},
          {"at_45_fps", held_json(claim.at_45_fps)},
          {"at_both", held_json(claim.at_both)},
          {"needs", claim.needs.empty() ? Json() : Json(claim.needs)}};
}

Json drawn_json(const Figure& figure) {
  return {{"id", figure.id},
          {"paper", figure.paper},
          {"scenario", figure.source.scenario},
          {"pipeline", figure.pipeline.empty() ? Json() : Json(figure.pipeline)},
          {"seed", figure.seed ? Json(*figure.seed) : Json()},
          {"caption", figure.caption},
          {"absent", figure.absent.empty() ? Json() : Json(figure.absent)}};
}

}  // namespace

std::string paper_json(const PaperResults& results) {
  Json root = new_document();
  root["runs"] = Json::array({run_json(results.at_15_fps), run_json(results.at_45_fps)});
  root["claims"] = Json::array();
  for (const PaperClaim& claim : paper_claims(results)) {
    root["claims"].push_back(paper_claim_json(claim));
  }
  root["table_4"] = results.table_4 ? Json::parse(reconstruction_json(*results.table_4)) : Json();
  root["no_table_4"] = results.no_table_4.empty() ? Json() : Json(results.no_table_4);
  root["figures"] = Json::array();
  for (const Figure& figure : results.figures) root["figures"].push_back(drawn_json(figure));
  return file_text(root);
}

}  // namespace simbench::reports
