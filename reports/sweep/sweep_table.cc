#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "evaluation/statistics/statistics.h"
#include "reports/sweep/sweep_report.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::ResponseRow;
using evaluation::SweepPlan;

constexpr std::array<std::int64_t, 8> kSeedCounts = {8, 16, 32, 64, 128, 256, 512, 1024};
constexpr std::array<double, 4> kWanted = {0.20, 0.10, 0.05, 0.02};

// "/hosts/clock/tick_ms" on three lines: columns of numbers are narrow.
std::string header_of(const std::string& pointer) {
  std::string header;
  for (const char c : pointer) {
    if (c == '/' && !header.empty()) header += '\n';
    header += c;
  }
  return header;
}

std::vector<Column> point_columns(const SweepPlan& plan) {
  std::vector<Column> columns;
  for (const std::string& pointer : plan.pointers()) columns.push_back({header_of(pointer)});
  columns.push_back({"pipeline", Align::kLeft});
  return columns;
}

std::vector<std::string> point_cells(const SweepPlan& plan, const ResponseRow& row) {
  std::vector<std::string> cells = plan.values(row.point);
  cells.push_back(plan.pipelines[row.pipeline]);
  return cells;
}

std::string counted(std::uint64_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string heading(const SweepPlan& plan) {
  return fmt::format("{}: {}, {}, {}", plan.scenario, counted(plan.points(), "point"),
                     counted(plan.pipelines.size(), "pipeline"), counted(plan.seeds, "seed"));
}

std::string percent_text(double share) {
  return share != share ? "-" : fmt::format("{:.1f} %", share * 100);
}

}  // namespace

Block response_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  std::vector<Column> columns = point_columns(plan);
  for (const char* name : {"AMD\nms", "AMD\n5-95 %", "absolute\nerror ms", "host\nerror ms",
                           "precision", "recall", "margin\nms"}) {
    columns.push_back({name});
  }
  Table table(std::move(columns));
  for (const ResponseRow& row : rows) {
    std::vector<std::string> cells = point_cells(plan, row);
    for (std::string& cell :
         std::array{number_text(row.of("amd_ms").median), band_text(row.of("amd_ms")),
                    number_text(row.of("absolute_error_ms").median),
                    number_text(row.of("host_error_ms").median), share_text(row.precision),
                    share_text(row.recall), number_text(row.of("margin_ms").median)}) {
      cells.push_back(std::move(cell));
    }
    table.add(std::move(cells));
  }
  return {.heading = heading(plan),
          .table = std::move(table),
          .prose = {"Medians over the seeds; precision and recall over all of them. Margin: the "
                    "gathering interval less the 99.9 % quantile of a seed's spreads."}};
}

Block host_order_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  std::size_t hosts = 0;
  for (const ResponseRow& row : rows) hosts = std::max(hosts, row.hosts.size());
  std::vector<Column> columns = point_columns(plan);
  for (std::size_t host = 1; host < hosts; ++host) columns.push_back({fmt::format("{}", host)});
  Table table(std::move(columns));
  for (const ResponseRow& row : rows) {
    std::vector<std::string> cells = point_cells(plan, row);
    for (std::size_t host = 1; host < hosts; ++host) {
      cells.push_back(host < row.hosts.size() ? number_text(row.hosts[host].median) : "");
    }
    table.add(std::move(cells));
  }
  return {.heading = "Clock error of each slave, in the order of their sessions",
          .table = std::move(table),
          .prose = {"Milliseconds: the median over the seeds of a host's |mean clock error| during "
                    "the capture. Host 1 is synchronised first and has run free for longest."}};
}

Block seeds_needed_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  std::vector<Column> columns = point_columns(plan);
  columns.push_back({"AMD\nms"});
  std::vector<std::int64_t> counts;
  for (const std::int64_t count : kSeedCounts) {
    if (count <= static_cast<std::int64_t>(plan.seeds)) counts.push_back(count);
  }
  for (const std::int64_t count : counts) {
    columns.push_back({fmt::format("+-\nn = {}", count)});
  }
  for (const double wanted : kWanted) {
    columns.push_back({fmt::format("seeds for\n+-{:.0f} %", wanted * 100)});
  }
  Table table(std::move(columns));
  for (const ResponseRow& row : rows) {
    const std::vector<double>& values = row.of("amd_ms").values;
    std::vector<std::string> cells = point_cells(plan, row);
    cells.push_back(number_text(row.of("amd_ms").median));
    for (const std::int64_t count : counts) {
      cells.push_back(percent_text(evaluation::median_interval(values, count).relative));
    }
    for (const double wanted : kWanted) {
      const std::optional<std::int64_t> seeds = evaluation::seeds_for(values, wanted);
      cells.push_back(seeds ? count_text(*seeds) : "-");
    }
    table.add(std::move(cells));
  }
  return {
      .heading =
          fmt::format("How far the median AMD of n seeds is from that of all {}", plan.seeds),
      .table = std::move(table),
      .prose = {"In 95 % of studies with n seeds the median lies within +- so many percent. The "
                "last columns turn that round; beyond the number of seeds run they go by the "
                "distribution that these have shown. Differences between pipelines need fewer: "
                "they are paired by seed."}};
}

}  // namespace simbench::reports
