#include "reports/results/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "reports/results/ground_truth_text.h"

namespace simbench::reports {
namespace {

using evaluation::Row;
using evaluation::SeedScore;

struct NamedSeries {
  const char* name;
  evaluation::Series Row::*series;
};

constexpr NamedSeries kSeries[] = {{"amd_ms", &Row::amd_ms},
                                   {"rmdv_ms", &Row::rmdv_ms},
                                   {"absolute_error_ms", &Row::absolute_error_ms},
                                   {"bias_ms", &Row::bias_ms},
                                   {"host_error_ms", &Row::host_error_ms},
                                   {"exposure_spread_ms", &Row::exposure_spread_ms}};

std::string line(const std::vector<std::string>& cells) {
  return fmt::format("{}\n", fmt::join(cells, ","));
}

std::vector<std::string> header() {
  std::vector<std::string> names = {"pipeline", "host_sync", "device_time", "gathering"};
  for (const NamedSeries& s : kSeries) {
    names.insert(names.end(),
                 {s.name, fmt::format("{}_p05", s.name), fmt::format("{}_p95", s.name)});
  }
  names.insert(names.end(),
               {"precision", "recall", "margin_ms", "frames_expected", "frames_delivered",
                "frames_dropped", "evaluated_pulses", "unsynchronised_hosts", "published_amd_ms",
                "published_amd_inside", "published_amd_percentile", "published_rmdv_ms",
                "published_rmdv_inside", "published_rmdv_attainable"});
  names.insert(names.end(), {"sets", "pure_sets", "partial_sets", "index_errors",
                             "discarded_frames", "set_amd_ms", "set_absolute_error_ms",
                             "emission_latency_ms", "emission_latency_max_ms"});
  return names;
}

std::string flag(bool value) { return value ? "1" : "0"; }

std::vector<std::string> published_cells(const Row& row) {
  if (!row.published) return std::vector<std::string>(6);
  const evaluation::PublishedComparison& published = *row.published;
  return {csv_cell(published.amd_ms),
          flag(published.amd_inside),
          csv_cell(published.amd_percentile.percent),
          csv_cell(published.rmdv_ms),
          flag(published.rmdv_inside),
          flag(published.rmdv_attainable)};
}

bool synchronised(const SeedScore& seed, std::size_t host) {
  return std::none_of(seed.failures.begin(), seed.failures.end(),
                      [host](const SyncOutcome& failure) { return failure.slave == host; });
}

}  // namespace

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_cell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string csv(const evaluation::Results& results) {
  const bool real = has_real_rows(results);
  std::vector<std::string> names = header();
  if (real) names.insert(names.end(), {"ground_truth", "verified", "notes"});
  std::string out = line(names);
  for (const Row& row : results.rows) {
    std::vector<std::string> cells = {csv_cell(row.pipeline), csv_cell(row.host_sync),
                                      csv_cell(row.device_time), csv_cell(row.gathering)};
    for (const NamedSeries& named : kSeries) {
      const evaluation::Series& series = row.*named.series;
      for (const double value : {series.median, series.p05, series.p95}) {
        cells.push_back(csv_cell(value));
      }
    }
    for (const double value : {row.precision, row.recall, row.margin_ms}) {
      cells.push_back(csv_cell(value));
    }
    for (const std::int64_t count : {row.frames.expected, row.frames.delivered, row.frames.dropped,
                                     row.evaluated_pulses, row.unsynchronised_hosts}) {
      cells.push_back(std::to_string(count));
    }
    const std::vector<std::string> published = published_cells(row);
    cells.insert(cells.end(), published.begin(), published.end());
    const auto if_verified = [&row](std::int64_t count) {
      return row.verified() ? std::to_string(count) : std::string();
    };
    cells.insert(cells.end(), {std::to_string(row.sets.emitted), if_verified(row.sets.pure),
                               std::to_string(row.sets.partial), if_verified(row.sets.index_errors),
                               std::to_string(row.sets.discarded_frames)});
    for (const double value : {row.set_amd_ms.median, row.set_absolute_error_ms.median,
                               row.emission_latency_ms.median, row.emission_latency_max_ms}) {
      cells.push_back(csv_cell(value));
    }
    if (real) {
      cells.insert(cells.end(),
                   {ground_truth_name(row.ground_truth), row.verified() ? "verified" : "unverified",
                    csv_cell(fmt::format("{}", fmt::join(row.notes, "; ")))});
    }
    out += line(cells);
  }
  return out;
}

void write_frames_csv(const evaluation::Results& results, std::ostream& out) {
  out << "pipeline,seed,pulse,spread_ms,deviation_ms\n";
  fmt::memory_buffer text;
  for (const Row& row : results.rows) {
    const std::string name = csv_cell(row.pipeline);
    for (const SeedScore& seed : row.seeds) {
      text.clear();
      for (const evaluation::PulseScore& pulse : seed.pulses) {
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", name, seed.seed, pulse.pulse,
                       pulse.spread_ms, pulse.deviation_ms);
      }
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
    }
  }
}

void write_hosts_csv(const evaluation::Results& results, std::ostream& out) {
  out << "pipeline,seed,host,error_ms,synchronised\n";
  for (const Row& row : results.rows) {
    for (const SeedScore& seed : row.seeds) {
      for (std::size_t host = 0; host < seed.host_errors_ms.size(); ++host) {
        out << fmt::format("{},{},{},{},{}\n", csv_cell(row.pipeline), seed.seed, host,
                           csv_cell(seed.host_errors_ms[host]), flag(synchronised(seed, host)));
      }
    }
  }
}

}  // namespace simbench::reports
