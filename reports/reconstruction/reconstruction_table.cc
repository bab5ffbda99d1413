#include <fmt/format.h>

#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "reports/reconstruction/reconstruction_report.h"
#include "reports/reconstruction/reconstruction_text.h"
#include "reports/text/number_text.h"
#include "reports/text/text_table.h"

namespace simbench::reports {
namespace {

using reconstruction::CurvePoint;
using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;
using reconstruction::SeedReprojection;
using scenarios::PublishedReprojection;

std::string heading(std::string_view text) { return fmt::format("\n{}\n\n", text); }

std::string title_line(const ReconstructionResults& results) {
  const std::string seeds = results.seeds == 1
                                ? fmt::format("1 seed ({})", results.first_seed)
                                : fmt::format("{} seeds ({}-{})", results.seeds, results.first_seed,
                                              results.first_seed + results.seeds - 1);
  return fmt::format("{}: {}, {} frame {} each\n", results.scenario.name, seeds, results.frames,
                     results.frames == 1 ? "set" : "sets");
}

std::string table_4(const ReconstructionResults& results) {
  TextTable table({{"pipeline", Align::kLeft},
                   {"mean error\ncm"},
                   {"published\nmean cm"},
                   {"standard deviation\ncm"},
                   {"published\nstd. dev. cm"}});
  for (const ReprojectionRow& row : results.rows) {
    table.add({row.pipeline, cm_text(row.mean_cm()),
               published_text(row.published, &PublishedReprojection::mean_cm, row.mean_cm()),
               cm_text(row.std_cm()),
               published_text(row.published, &PublishedReprojection::std_cm, row.std_cm())});
  }
  return table.plain();
}

std::string total(const ReprojectionRow& row, std::int64_t SeedReprojection::*member) {
  std::int64_t sum = 0;
  for (const SeedReprojection& seed : row.seeds) sum += seed.*member;
  return count_text(sum);
}

std::string sets_table(const ReconstructionResults& results) {
  TextTable table({{"pipeline", Align::kLeft},
                   {"median\ncm"},
                   {"95 %\ncm"},
                   {"desynchronisation\nms"},
                   {"seeds without\na gathered set"},
                   {"sets"},
                   {"failed"},
                   {"missing\nframes"}});
  for (const ReprojectionRow& row : results.rows) {
    table.add({row.pipeline, cm_text(row.median_cm().median), cm_text(row.p95_cm().median),
               ms_text(row.desync_ms()), share_text(no_gathered_set_share(row)),
               total(row, &SeedReprojection::sets), total(row, &SeedReprojection::failed_sets),
               total(row, &SeedReprojection::missing_frames)});
  }
  return table.plain();
}

// A row for each speed, a column for each desynchronisation.
std::string curve_table(const std::vector<CurvePoint>& curve) {
  std::set<double> steps;
  for (const CurvePoint& point : curve) steps.insert(point.desync_ms);
  std::vector<Column> columns = {{"speed", Align::kLeft}};
  for (const double ms : steps) columns.push_back({fmt::format("{:g} ms", ms)});
  std::vector<std::string> speeds;
  std::map<std::string, std::map<double, double>> errors;
  for (const CurvePoint& point : curve) {
    const std::string speed = speed_text(point.speed_m_per_s, point.speed_factor);
    if (!errors.contains(speed)) speeds.push_back(speed);
    errors[speed][point.desync_ms] = evaluation::median(point.mean_cm);
  }
  TextTable table(columns);
  for (const std::string& speed : speeds) {
    std::vector<std::string> cells = {speed};
    for (const double ms : steps) {
      const auto found = errors[speed].find(ms);
      cells.push_back(found == errors[speed].end() ? "-" : cm_text(found->second));
    }
    table.add(cells);
  }
  return table.plain();
}

std::string limits_table(const std::vector<SyncLimit>& limits) {
  TextTable table({{"speed", Align::kLeft},
                   {"floor\ncm"},
                   {"desynchronisation\nup to, ms"},
                   {"cost there\ncm/ms"}});
  for (const SyncLimit& limit : limits) {
    table.add({speed_text(limit.speed_m_per_s, limit.speed_factor), cm_text(limit.floor_cm),
               limit_text(limit), cost_text(limit)});
  }
  return table.plain();
}

std::string row_notes(const ReconstructionResults& results) {
  std::string text;
  for (const ReprojectionRow& row : results.rows) {
    for (const std::string& note : row.notes) {
      text += wrapped(fmt::format("{}: {}", row.pipeline, note), 2);
    }
  }
  return text.empty() ? "" : "\nWhat went wrong\n" + text;
}

std::string conclusions(const ReconstructionResults& results) {
  std::string text;
  if (const auto ratio = published_ratio(results.rows)) text += wrapped(ratio_sentence(*ratio));
  if (results.speed_needed) text += wrapped(speed_sentence(*results.speed_needed));
  return text.empty() ? "" : "\n" + text;
}

std::string curve_part(const ReconstructionResults& results) {
  if (results.curve.empty()) return "";
  return heading("Median mean error in cm, all hosts off by a known amount") +
         curve_table(results.curve) +
         heading("How good must my synchronisation be for my subject?") +
         limits_table(sync_limits(results.curve));
}

std::string legend(const ReconstructionResults& results) {
  std::string text = "\nHow to read it\n";
  text += wrapped(kErrorLegend, 2) + wrapped(kDesyncLegend, 2);
  if (published_ratio(results.rows)) text += wrapped(kPublishedLegend, 2);
  if (!results.curve.empty()) text += wrapped(kLimitLegend, 2);
  return text;
}

}  // namespace

std::string reconstruction_table(const ReconstructionResults& results) {
  std::string text = title_line(results) + wrapped(results.scenario.summary, 0) +
                     heading("Reprojection error") + table_4(results) +
                     heading("How it came about") + sets_table(results) + conclusions(results) +
                     curve_part(results) + row_notes(results) + legend(results);
  text += "\nWhat was simulated\n";
  for (const std::string& note : honest_notes(results)) text += wrapped(note, 2);
  text += "\nPipelines = host_sync + device_time + gathering\n";
  for (const ReprojectionRow& row : results.rows) {
    text += wrapped(fmt::format("{} = {} + {} + {}", row.pipeline, row.host_sync, row.device_time,
                                row.gathering),
                    2);
  }
  return fitted(text + fmt::format("\nCost: {:.1f} s; {:.1f} s for a frame set on one thread.\n",
                                   results.wall_s, results.seconds_per_set));
}

}  // namespace simbench::reports
