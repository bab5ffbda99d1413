#include "reports/reality/reality_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/version.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::RealityRow;
using evaluation::RealitySpan;
using scenarios::UnknownParameter;

std::string range_text(double least, double largest) {
  return least == largest ? number_text(least) : number_text(least) + " to " + number_text(largest);
}

std::string reality_verdict(const RealityRow& row) {
  const std::string within =
      fmt::format("{} {:g}", row.is_within() ? "within" : "NOT within", row.setting->factor);
  return row.counts() ? within : within + " (known)";
}

double least_of(const std::vector<double>& values) { return *std::ranges::min_element(values); }
double most_of(const std::vector<double>& values) { return *std::ranges::max_element(values); }

Table rows_table(const RealityResult& result) {
  const std::vector<Field<RealityRow>> fields = {
      {{"setting", Align::kLeft}, [](const RealityRow& row) { return row.setting->name; }},
      {{"measured us"}, [](const RealityRow& row) { return number_text(row.measured_us()); }},
      {{"from to"},
       [](const RealityRow& row) {
         return range_text(row.least_measured_us(), row.largest_measured_us());
       }},
      {{"predicted us"}, [](const RealityRow& row) { return number_text(row.median_us()); }},
      {{"over seeds"},
       [](const RealityRow& row) {
         return range_text(least_of(row.predicted_us), most_of(row.predicted_us));
       }},
      {{"ratio"}, [](const RealityRow& row) { return fmt::format("{:.2f}", row.ratio()); }},
      {{"verdict", Align::kLeft}, reality_verdict}};
  return table_of(fields, result.rows);
}

// What the prediction of each row spans with the other values of an unknown parameter.
Block unknown_block(const RealityResult& result) {
  Block block{.heading = "What is unknown of it, and what it spans"};
  for (const UnknownParameter& unknown : result.recording->unknown) {
    std::vector<std::string> spans;
    for (const RealityRow& row : result.rows) {
      std::vector<double> values = {row.median_us()};
      for (const RealitySpan& span : row.spans) {
        if (span.parameter == &unknown) values.push_back(span.predicted_us);
      }
      const bool moves = values.size() > 1 && most_of(values) > 1.1 * least_of(values);
      if (!moves) continue;
      spans.push_back(fmt::format("{} {} us", row.setting->name,
                                  range_text(least_of(values), most_of(values))));
    }
    std::string line = fmt::format("{} ({} = {}; {}).", unknown.what, unknown.pointer,
                                   unknown.nominal, unknown.source);
    for (const std::string& span : spans) line += " " + span + ".";
    block.items.push_back(std::move(line));
  }
  return block;
}

std::string reality_headline(const std::vector<RealityResult>& results) {
  std::size_t counted = 0;
  std::size_t within = 0;
  double worst = 1;
  std::string where;
  for (const RealityResult& result : results) {
    for (const RealityRow& row : result.rows) {
      if (!row.counts()) continue;
      ++counted;
      within += row.is_within();
      const double off = std::max(row.ratio(), 1 / row.ratio());
      if (off <= worst) continue;
      worst = off;
      where = row.setting->name;
    }
  }
  if (counted == 0) return "No figure was looked at only after its prediction.";
  std::string text = fmt::format(
      "{} of {} figures that nothing was chosen by are predicted within "
      "their factor",
      within, counted);
  return where.empty()
             ? text + "."
             : text + fmt::format("; the furthest is off by a factor of {:.1f}: {}.", worst, where);
}

Json us_json(double median, const std::vector<double>& values) {
  return {{"median", median}, {"least", least_of(values)}, {"largest", most_of(values)}};
}

Json setting_json(const RealityRow& row) {
  const scenarios::RealitySetting& setting = *row.setting;
  Json out = {{"name", setting.name},
              {"scenario", setting.scenario},
              {"pipeline", setting.pipeline},
              {"host", setting.host},
              {"quantity", to_text(setting.quantity)},
              {"measured_us", us_json(row.measured_us(), setting.measured_us)},
              {"predicted_us", us_json(row.median_us(), row.predicted_us)},
              {"ratio", row.ratio()},
              {"factor", setting.factor},
              {"is_within", row.is_within()},
              {"used_for", setting.used_for},
              {"spans", Json::array()}};
  out["predicted_us"]["values"] = row.predicted_us;
  for (const RealitySpan& span : row.spans) {
    out["spans"].push_back({{"what", span.parameter->what},
                            {"pointer", span.parameter->pointer},
                            {"value", span.value},
                            {"predicted_us", span.predicted_us}});
  }
  return out;
}

}  // namespace

Document reality_document(const std::vector<RealityResult>& results) {
  Document document{
      .title = "The bench beside reality",
      .head = {
          reality_headline(results),
          "A prediction has its parameters from documents alone. (known): the figure was known "
          "when the mechanism was chosen, so it does not count. Measured: the median and the "
          "range of the recording's stretches or devices; predicted: of the seeds."}};
  for (const RealityResult& result : results) {
    const scenarios::RealRecording& recording = *result.recording;
    document.blocks.push_back(
        {.heading = recording.title,
         .table = rows_table(result),
         .prose = {fmt::format("Source: {}. Truth: {}.", recording.source, recording.instrument)}});
    document.blocks.push_back(unknown_block(result));
  }
  return document;
}

std::string reality_json(const std::vector<RealityResult>& results) {
  Json root = {{"schema_version", 1},
               {"kind", "reality"},
               {"version", version()},
               {"commit", commit()},
               {"recordings", Json::array()}};
  for (const RealityResult& result : results) {
    const scenarios::RealRecording& recording = *result.recording;
    Json out = {{"name", recording.name},
                {"title", recording.title},
                {"source", recording.source},
                {"instrument", recording.instrument},
                {"duration_s", recording.duration_s},
                {"from_s", recording.from_s},
                {"rows", Json::array()},
                {"unknown", Json::array()}};
    for (const RealityRow& row : result.rows) out["rows"].push_back(setting_json(row));
    for (const UnknownParameter& unknown : recording.unknown) {
      out["unknown"].push_back({{"what", unknown.what},
                                {"pointer", unknown.pointer},
                                {"nominal", unknown.nominal},
                                {"source", unknown.source}});
    }
    root["recordings"].push_back(std::move(out));
  }
  return file_text(root);
}

}  // namespace simbench::reports
