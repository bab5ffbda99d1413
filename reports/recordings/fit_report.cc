#include "reports/recordings/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

using evaluation::FitCheck;
using evaluation::FitSide;
using evaluation::FittedValue;
using evaluation::kFitQuantiles;

constexpr std::size_t kCamerasShown = 24;

std::string estimate_text(const std::optional<FittedValue>& estimate) {
  return estimate ? fmt::format("{:.3f} +- {:.3f}", estimate->value, estimate->error) : "-";
}

std::string drop_text(const FitSide& side) {
  if (!side.drops) return "not counted";
  const evaluation::DropFit& drops = *side.drops;
  return fmt::format("{} [{}-{}]", share_text(drops.share()), share_text(drops.interval.low),
                     share_text(drops.interval.high));
}

std::string lines_text(const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = "\n" + heading + "\n";
  for (const std::string& line : lines) text += wrapped("- " + printable_name(line), 2);
  return text;
}

std::string verdicts_text(const FitCheck& check) {
  std::string text;
  for (const evaluation::FitVerdict& verdict : check.verdicts) {
    text +=
        wrapped(fmt::format("{} {}",
                            verdict.agrees ? "agrees: " : "DIFFERS:", printable_name(verdict.text)),
                2);
  }
  return text;
}

std::string delay_distance_text(const FitCheck& check) {
  return fmt::format(
      "Kolmogorov-Smirnov distance {:.4f} but for a constant; two samples of one distribution "
      "exceed {:.4f} in 5 % of all cases at most.",
      check.ks, check.ks_limit);
}

Table fit_check_table(const FitCheck& check, const std::vector<std::string>& cameras) {
  Table table({{"", Align::kLeft}, {"recorded"}, {"simulated"}});
  const FitSide& recorded = check.recorded;
  const FitSide& simulated = check.simulated;
  table.add({"frames", count_text(recorded.frames), count_text(simulated.frames)});
  for (std::size_t i = 0; i < kFitQuantiles.size(); ++i) {
    table.add({fmt::format("excess delay {:g} %, ms", kFitQuantiles[i] * 100),
               fmt::format("{:.4f}", recorded.excess_ms[i]),
               fmt::format("{:.4f}", simulated.excess_ms[i])});
  }
  table.add({"correlation of frames", estimate_text(recorded.correlation),
             estimate_text(simulated.correlation)});
  table.add({"frames dropped", drop_text(recorded), drop_text(simulated)});
  for (std::size_t i = 0; i < std::min(cameras.size(), kCamerasShown); ++i) {
    table.add({fmt::format("drift of {}, ppm", cameras[i]), estimate_text(recorded.skew_ppm[i]),
               estimate_text(simulated.skew_ppm[i])});
  }
  return table;
}

std::string fit_check_text(const std::string& heading, const FitCheck& check,
                           const std::vector<std::string>& cameras) {
  return fmt::format("\n{}\n\n{}\n{}\n{}", heading, plain(fit_check_table(check, cameras)),
                     delay_distance_text(check), verdicts_text(check));
}

constexpr const char* kFitLegend = R"(
How to read it
  excess delay: the delay of a frame over the quickest frames of its stream.
  +- is a standard error, [..] a 95 % interval. Drift: device rate / host rate - 1.
  Hold-out: fitted to the first half of each stream, compared with the second half.
  agrees, DIFFERS: 5 % of good models differ in their delays, 5 % in anything else.
)";

Json fitted_json(const std::optional<FittedValue>& estimate) {
  if (!estimate) return nullptr;
  const evaluation::Interval interval = evaluation::interval_of(*estimate);
  return {{"value", estimate->value},
          {"error", estimate->error},
          {"low", interval.low},
          {"high", interval.high}};
}

Json share_json(const FitSide& side) {
  if (!side.drops) return nullptr;
  return {{"value", side.drops->share()},
          {"low", side.drops->interval.low},
          {"high", side.drops->interval.high}};
}

Json fit_check_json(const char* name, const FitCheck& check,
                    const std::vector<std::string>& cameras) {
  const FitSide& recorded = check.recorded;
  const FitSide& simulated = check.simulated;
  Json quantiles = Json::array();
  for (std::size_t i = 0; i < kFitQuantiles.size(); ++i) {
    quantiles.push_back({{"probability", kFitQuantiles[i]},
                         {"recorded", recorded.excess_ms[i]},
                         {"simulated", simulated.excess_ms[i]}});
  }
  Json skews = Json::array();
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    skews.push_back({{"camera", cameras[i]},
                     {"recorded", fitted_json(recorded.skew_ppm[i])},
                     {"simulated", fitted_json(simulated.skew_ppm[i])}});
  }
  Json verdicts = Json::array();
  for (const evaluation::FitVerdict& verdict : check.verdicts) {
    verdicts.push_back(
        {{"what", verdict.what}, {"agrees", verdict.agrees}, {"text", verdict.text}});
  }
  return {
      {"check", name},
      {"ks", check.ks},
      {"ks_limit", check.ks_limit},
      {"verdicts", verdicts},
      {"excess_ms", quantiles},
      {"skew_ppm", skews},
      {"correlation",
       {{"recorded", fitted_json(recorded.correlation)},
        {"simulated", fitted_json(simulated.correlation)}}},
      {"drop_share", {{"recorded", share_json(recorded)}, {"simulated", share_json(simulated)}}},
      {"frames", {{"recorded", recorded.frames}, {"simulated", simulated.frames}}}};
}

}  // namespace

Block fit_check_block(const std::string& heading, const FitCheck& check,
                      const std::vector<std::string>& cameras) {
  Block block{.heading = heading, .table = fit_check_table(check, cameras)};
  block.prose.push_back(delay_distance_text(check));
  for (const evaluation::FitVerdict& verdict : check.verdicts) {
    block.items.push_back((verdict.agrees ? "agrees: " : "DIFFERS: ") + verdict.text);
  }
  return block;
}

std::string fit_table(const FitReport& report) {
  std::string text =
      printable_name(fmt::format("{} fitted over {}: {}", fmt::join(report.inputs, ", "),
                                 report.base, report.model)) +
      "\n";
  if (!report.capture.empty()) text += fmt::format("capture: {}\n", printable_name(report.capture));
  const evaluation::FitTrust& trust = report.study.trust;
  text += "\n" + wrapped(printable_name(trust.text), 0);
  text += lines_text("Fitted", report.study.model.evidence);
  text += lines_text("Not identified", report.study.model.not_identified);
  text += lines_text("Left out of the model", report.study.model.left_out);
  text += fit_check_text("Recording and simulated model", report.study.whole, report.cameras);
  if (report.study.hold_out) {
    text += fit_check_text("Hold-out: second half, and the simulated model of the first half",
                           *report.study.hold_out, report.cameras);
  } else {
    text += fmt::format("\nNo hold-out: it needs {} frames of a stream.\n",
                        2 * evaluation::kFewestFrames);
  }
  return text + kFitLegend;
}

std::string fit_json(const FitReport& report) {
  Json checks = {fit_check_json("whole", report.study.whole, report.cameras)};
  if (report.study.hold_out) {
    checks.push_back(fit_check_json("hold_out", *report.study.hold_out, report.cameras));
  }
  const Json root = {
      {"schema_version", 1},
      {"version", version()},
      {"commit", commit()},
      {"inputs", report.inputs},
      {"capture", report.capture.empty() ? Json(nullptr) : Json(report.capture)},
      {"base", report.base},
      {"model", report.model},
      {"trust",
       {{"holds", report.study.trust.holds ? Json(*report.study.trust.holds) : Json(nullptr)},
        {"held_out", report.study.trust.held_out},
        {"text", report.study.trust.text}}},
      {"evidence", report.study.model.evidence},
      {"not_identified", report.study.model.not_identified},
      {"left_out", report.study.model.left_out},
      {"checks", checks}};
  return file_text(root);
}

}  // namespace simbench::reports
