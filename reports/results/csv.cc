#include "reports/results/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/answer/standing.h"
#include "evaluation/scoring/rows.h"
#include "recording/text_fields.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/results_document.h"

namespace simbench::reports {
namespace {

using evaluation::CsvForm;
using evaluation::Metric;
using evaluation::Row;
using evaluation::SeedScore;

void add_names(CsvForm form, std::vector<std::string>& names) {
  for (const Metric& metric : evaluation::metrics()) {
    if (metric.csv == form) names.emplace_back(metric.id);
    if (metric.csv != form || form != CsvForm::kBand) continue;
    names.push_back(fmt::format("{}_p05", metric.id));
    names.push_back(fmt::format("{}_p95", metric.id));
  }
}

void add_cells(CsvForm form, const Row& row, std::vector<std::string>& cells) {
  for (const Metric& metric : evaluation::metrics()) {
    if (metric.csv != form) continue;
    if (metric.is_count()) {
      cells.push_back(metric.is_known(row) ? std::to_string(metric.count(row)) : "");
    } else {
      cells.push_back(csv_cell(metric.value(row)));
    }
    if (form != CsvForm::kBand) continue;
    cells.push_back(csv_cell(metric.series(row).p05));
    cells.push_back(csv_cell(metric.series(row).p95));
  }
}

std::vector<std::string> header(const std::vector<StageInfo>& stages) {
  std::vector<std::string> names = {"pipeline"};
  for (const StageInfo& stage : stages) names.emplace_back(stage.name);
  add_names(CsvForm::kBand, names);
  add_names(CsvForm::kValue, names);
  names.insert(names.end(),
               {"published_amd_ms", "published_amd_inside", "published_amd_percentile",
                "published_rmdv_ms", "published_rmdv_inside", "published_rmdv_attainable"});
  add_names(CsvForm::kValueAtEnd, names);
  names.insert(names.end(), {"scored_seeds", "standing", "failed"});
  return names;
}

std::string flag(bool value) { return value ? "1" : "0"; }

// Empty with too few seeds to tell.
std::string inside_flag(const evaluation::Percentile& percentile) {
  const evaluation::Placement placement = evaluation::placement_of(percentile);
  if (placement == evaluation::Placement::kTooFewSeeds) return "";
  return flag(placement == evaluation::Placement::kInside);
}

std::vector<std::string> published_cells(const Row& row) {
  if (!row.published) return std::vector<std::string>(6);
  const evaluation::PublishedComparison& published = *row.published;
  return {csv_cell(published.amd_ms),
          inside_flag(published.amd_percentile),
          csv_cell(published.amd_percentile.percent),
          csv_cell(published.rmdv_ms),
          inside_flag(published.rmdv_percentile),
          flag(published.rmdv_attainable)};
}

// "amd_ms at_most 2.5 holds; rmdv_ms value 1.34"; without a verdict: too few seeds to tell.
std::string figures_cell(const evaluation::Results& results, const Row& row) {
  std::vector<std::string> figures;
  for (const evaluation::FigureComparison& compared : results.published_figures) {
    const scenarios::PublishedFigure& figure = compared.figure;
    if (figure.pipeline != row.pipeline) continue;
    const std::string_view verdict = evaluation::verdict_word(compared.verdict);
    figures.push_back(fmt::format("{} {} {}{}{}", figure.metric, figure.number_name(),
                                  figure.number(), verdict.empty() ? "" : " ", verdict));
  }
  return csv_cell(fmt::format("{}", fmt::join(figures, "; ")));
}

// The cells of hosts.csv from t_l_ms on, with commas between them.
std::string session_cells(const SeedScore& seed, std::size_t host) {
  const auto found = std::ranges::find(seed.sessions, host, &SessionDelays::slave);
  if (found == seed.sessions.end()) return ",,,,,";
  return fmt::format("{},{},{},{},{},{}", csv_cell(to_ms(found->t_l)), csv_cell(to_ms(found->t_t)),
                     csv_cell(to_ms(found->t_d)), found->pass, csv_cell(to_ms(found->get)),
                     csv_cell(to_ms(found->set)));
}

bool synchronised(const SeedScore& seed, std::size_t host) {
  return std::none_of(seed.failures.begin(), seed.failures.end(),
                      [host](const SyncOutcome& failure) { return failure.slave == host; });
}

}  // namespace

LineEnds::LineEnds(const scenarios::Derivation& derivation) {
  const std::string changed = scenarios::changed_text(derivation);
  if (changed.empty()) return;
  header = ",changed\n";
  line = fmt::format(",{}\n", csv_cell(changed));
}

std::string csv(const evaluation::Results& results) {
  const bool real = has_real_rows(results) || !note_lines(results).empty();
  const std::vector<StageInfo> stages = present_stages(results.rows);
  std::vector<std::string> names = header(stages);
  const bool has_figures = !results.published_figures.empty();
  if (has_figures) names.emplace_back("published_figures");
  if (real) names.insert(names.end(), {"ground_truth", "verified", "notes"});
  const LineEnds ends(results.derivation);
  const evaluation::RankedBy ranked_by = evaluation::ranking_of(results);
  std::string out = fmt::format("{}{}", fmt::join(names, ","), ends.header);
  for (const Row& row : results.rows) {
    std::vector<std::string> cells = {csv_cell(row.pipeline)};
    for (const StageInfo& stage : stages) cells.push_back(csv_cell(at_stage(row, stage.id)));
    add_cells(CsvForm::kBand, row, cells);
    add_cells(CsvForm::kValue, row, cells);
    const std::vector<std::string> published = published_cells(row);
    cells.insert(cells.end(), published.begin(), published.end());
    add_cells(CsvForm::kValueAtEnd, row, cells);
    cells.push_back(std::to_string(evaluation::scored_seeds(row)));
    const evaluation::ReasonedStanding standing = evaluation::standing_of(row, ranked_by);
    cells.emplace_back(evaluation::standing_id(standing.is));
    cells.push_back(csv_cell(standing.reason));
    if (has_figures) cells.push_back(figures_cell(results, row));
    if (real) {
      cells.insert(cells.end(),
                   {ground_truth_name(row.ground_truth), row.verified() ? "verified" : "unverified",
                    csv_cell(fmt::format("{}", fmt::join(row.notes, "; ")))});
    }
    out += fmt::format("{}{}", fmt::join(cells, ","), ends.line);
  }
  return out;
}

std::string tidy_csv(const evaluation::Results& results) {
  const LineEnds ends(results.derivation);
  std::string out = "scenario,pipeline,seed,metric,unit,value" + ends.header;
  for (const Row& row : results.rows) {
    const std::string start =
        fmt::format("{},{}", csv_cell(results.scenario), csv_cell(row.pipeline));
    for (const Metric& metric : evaluation::metrics(results.kind)) {
      if (!metric.is_series()) continue;
      const std::vector<double>& values = metric.series(row).values;
      for (std::size_t seed = 0; seed < values.size(); ++seed) {
        if (!std::isfinite(values[seed])) continue;
        out += fmt::format("{},{},{},{},{}{}", start, results.first_seed + seed, metric.id,
                           metric.unit, csv_cell(values[seed]), ends.line);
      }
    }
  }
  return out;
}

void write_frames_csv(const evaluation::Results& results, std::ostream& out) {
  const LineEnds ends(results.derivation);
  out << "pipeline,seed,pulse,amd_ms,rmdv_ms" << ends.header;
  fmt::memory_buffer text;
  for (const Row& row : results.rows) {
    const std::string name = csv_cell(row.pipeline);
    for (const SeedScore& seed : row.seeds) {
      text.clear();
      for (const evaluation::PulseScore& pulse : seed.pulses) {
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{}{}", name, seed.seed, pulse.pulse,
                       csv_cell(pulse.spread_ms), csv_cell(pulse.deviation_ms), ends.line);
      }
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
    }
  }
}

void write_hosts_csv(const evaluation::Results& results, std::ostream& out) {
  const LineEnds ends(results.derivation);
  out << kHostsHeader << ends.header;
  for (const Row& row : results.rows) {
    for (const SeedScore& seed : row.seeds) {
      for (std::size_t host = 0; host < seed.host_errors_ms.size(); ++host) {
        out << fmt::format("{},{},{},{},{},{}{}", csv_cell(row.pipeline), seed.seed, host,
                           csv_cell(seed.host_errors_ms[host]), flag(synchronised(seed, host)),
                           session_cells(seed, host), ends.line);
      }
    }
  }
}

}  // namespace simbench::reports
