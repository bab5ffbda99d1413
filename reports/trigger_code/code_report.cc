#include "reports/trigger_code/code_report.h"

#include <fmt/format.h>

#include <cmath>

#include "recording/version.h"
#include "reports/results/json.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

double in_microseconds(Nanoseconds time) { return to_ns(time) * 1e-3; }

double pulses_per_second(const TriggerCode& code) { return 1e9 / to_ns(code.period()); }

double search_seconds(const TriggerCodeResult& result) {
  return result.forecast.pulses_worst * to_seconds(result.code.period());
}

std::string code_interval_text(Nanoseconds interval) {
  return decimals_text(in_microseconds(interval), 1);
}

std::string symbols_text(const scenarios::TriggerCodeModel& model) {
  switch (model.kind) {
    case scenarios::CodeKind::kPosition:
      return fmt::format("each pulse {:g} us early or late", model.shift_us);
    case scenarios::CodeKind::kMissing:
      return fmt::format("the last of {} pulses left out or not", model.pulses_per_symbol);
    case scenarios::CodeKind::kFrequency:
      break;
  }
  return fmt::format("{} of {} intervals {:g} us longer and the others shorter, or the other way",
                     model.pulses_per_symbol / 2, model.pulses_per_symbol, model.shift_us);
}

Table properties_table(const TriggerCodeResult& result) {
  const TriggerCode& code = result.code;
  Table table({{"property", Align::kLeft}, {"value", Align::kLeft}});
  table.add({"symbol", symbols_text(result.model)});
  table.add({"sequence", fmt::format("de Bruijn of order {}, {} symbols", result.model.order,
                                     count_text(std::int64_t{1} << result.model.order))});
  table.add({"span", fmt::format("{} pulses, {} s; then the code begins anew",
                                 count_text(code.length()), number_text(to_seconds(code.span())))});
  table.add({"mean rate", decimals_text(pulses_per_second(code), 3) + " Hz"});
  table.add({"pulses that are sent", share_text(code.sent_share())});
  table.add({"intervals", fmt::format("{} to {} us, of {} us without the code",
                                      code_interval_text(code.shortest_interval()),
                                      code_interval_text(code.longest_interval()),
                                      code_interval_text(code.period()))});
  return table;
}

// Probabilities that are no number are as good as none.
std::string code_probability_text(double probability) {
  return probability > 0 && probability < 1e-99 ? "below 1e-99" : number_text(probability);
}

Block forecast_block(const TriggerCodeResult& result) {
  const CodeForecast& forecast = result.forecast;
  Block block{.heading = "How soon a camera finds its place"};
  if (forecast.found < forecast.places) {
    block.is_warning = true;
    block.prose.push_back(fmt::format(
        "From {} of {} places a camera does NOT find its place within {} frames: the noise of its "
        "stamps ({:g} us, /algorithms/coded_trigger/noise_us) hides the code.",
        forecast.places - forecast.found, forecast.places, CodeSearch::kMostHeld,
        result.settings.noise.noise_us));
    if (forecast.found == 0) return block;
  }
  Table table({{"property", Align::kLeft}, {"value", Align::kLeft}});
  table.add({"frames", fmt::format("{} (median of {} places), {} at most",
                                   number_text(forecast.frames_median), forecast.places,
                                   number_text(forecast.frames_worst))});
  table.add({"time without losses", number_text(search_seconds(result)) + " s at most"});
  table.add({"probability of a wrong place",
             fmt::format("at most {:.0e} is accepted", result.settings.error_probability)});
  if (std::isfinite(forecast.union_bound)) {
    table.add({"union bound of the same", code_probability_text(forecast.union_bound)});
  }
  block.table = std::move(table);
  block.prose.push_back(fmt::format(
      "For stamps with {:g} us of noise and clocks within {:g} ppm (standard deviations). Each "
      "lost frame takes one more.",
      result.settings.noise.noise_us, result.settings.noise.rate_error_ppm));
  return block;
}

std::string mode_verdict(const CodeMode& mode) {
  if (!mode.problem.empty()) return mode.problem;
  return mode.limits.pulses_per_frame == 1
             ? "follows every pulse"
             : fmt::format("answers one in {} pulses", mode.limits.pulses_per_frame);
}

Block modes_block(const TriggerCodeResult& result) {
  const std::vector<Field<CodeMode>> fields = {
      {{"camera", Align::kLeft}, &CodeMode::camera},
      {{"mode", Align::kLeft},
       [](const CodeMode& mode) { return mode.mode + (mode.is_own ? " (own)" : ""); }},
      {{"stream", Align::kLeft}, &CodeMode::stream},
      {{"mode Hz"}, [](const CodeMode& mode) { return number_text(mode.mode_rate_hz); }},
      {{"takes from us"},
       [](const CodeMode& mode) { return code_interval_text(mode.limits.shortest); }},
      {{"to us"},
       [](const CodeMode& mode) {
         return mode.limits.longest == Nanoseconds::max() ? "any"
                                                          : code_interval_text(mode.limits.longest);
       }},
      {{"frames/s"},
       [](const CodeMode& mode) {
         return mode.problem.empty() ? decimals_text(mode.frames_per_s, 2) : "-";
       }},
      {{"verdict", Align::kLeft}, mode_verdict}};
  return {.heading = "What each sync mode makes of it",
          .table = table_of(fields, result.modes, 3),
          .prose = {"Intervals are those from one answered pulse to the next. What a mode takes is "
                    "in part an assumption: docs/coded_trigger.md section 3."}};
}

}  // namespace

Document trigger_code_document(const TriggerCodeResult& result) {
  return {.title = fmt::format("The coded trigger of {}",
                               scenarios::named(result.scenario, result.derivation)),
          .head = scenarios::derivation_lines(result.derivation),
          .blocks = {{.heading = "The code", .table = properties_table(result)},
                     forecast_block(result),
                     modes_block(result)}};
}

std::string trigger_code_json(const TriggerCodeResult& result) {
  const TriggerCode& code = result.code;
  const CodeForecast& forecast = result.forecast;
  Json root = {{"schema_version", 1},
               {"kind", "trigger_code"},
               {"version", version()},
               {"commit", commit()},
               {"scenario", result.scenario}};
  state_derivation(result.derivation, root);
  root["code"] = {{"kind", to_text(result.model.kind)},
                  {"order", result.model.order},
                  {"length_pulses", code.length()},
                  {"span_s", to_seconds(code.span())},
                  {"shift_us", result.model.shift_us},
                  {"pulses_per_symbol", result.model.pulses_per_symbol},
                  {"rate_hz", pulses_per_second(code)},
                  {"sent_share", code.sent_share()},
                  {"shortest_interval_us", in_microseconds(code.shortest_interval())},
                  {"longest_interval_us", in_microseconds(code.longest_interval())}};
  root["search"] = {{"noise_us", result.settings.noise.noise_us},
                    {"rate_error_ppm", result.settings.noise.rate_error_ppm},
                    {"error_probability", result.settings.error_probability},
                    {"places", forecast.places},
                    {"found", forecast.found},
                    {"wrong", forecast.wrong},
                    {"frames_median", forecast.frames_median},
                    {"frames_worst", forecast.frames_worst},
                    {"seconds_worst", search_seconds(result)},
                    {"union_bound", nullptr}};
  if (std::isfinite(forecast.union_bound)) root["search"]["union_bound"] = forecast.union_bound;
  root["modes"] = Json::array();
  for (const CodeMode& mode : result.modes) {
    Json out = {{"camera", mode.camera},
                {"mode", mode.mode},
                {"stream", mode.stream},
                {"mode_rate_hz", mode.mode_rate_hz},
                {"follows", mode.problem.empty()},
                {"frames_per_s", mode.problem.empty() ? Json(mode.frames_per_s) : Json()},
                {"takes_from_us", in_microseconds(mode.limits.shortest)},
                {"takes_to_us", nullptr},
                {"problem", mode.problem}};
    if (mode.limits.longest != Nanoseconds::max()) {
      out["takes_to_us"] = in_microseconds(mode.limits.longest);
    }
    root["modes"].push_back(std::move(out));
  }
  return file_text(root);
}

}  // namespace simbench::reports
