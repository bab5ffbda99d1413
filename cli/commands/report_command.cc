#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "app/figure_source.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/progress.h"
#include "recording/collected.h"
#include "reports/archive/archive.h"
#include "reports/page/html_report.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostSeedsInDetail = 1000;

constexpr const char* kReportExamples = R"(
The file is complete: it opens offline in any browser, and can be mailed and printed.

Examples:
  simbench run --scenario 18cam_6host_45fps --output results/monday
  simbench report results/monday                    writes results/monday.html
  simbench report results/monday results/tuesday -o both.html --budget-seeds 0
  simbench report results/monday -o two.html --pipelines yoon2021_both,genlock --seeds-in-detail 10

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct ReportOptions {
  std::vector<std::string> archives;
  std::string output;
  app::ReportDetail detail;
  std::vector<std::string> command;
};

void check_named_once(const std::vector<std::string>& paths) {
  std::vector<fs::path> known;
  for (const std::string& path : paths) {
    std::error_code error;
    const fs::path full = fs::weakly_canonical(path, error);
    if (std::find(known.begin(), known.end(), full) != known.end()) {
      throw scenarios::InputError(fmt::format("{}: is named twice; name every archive once", path));
    }
    known.push_back(full);
  }
}

void check_pipelines(const app::ReportDetail& detail,
                     const std::vector<reports::Archive>& archives) {
  for (const std::string& pipeline : detail.pipelines) {
    for (const reports::Archive& archive : archives) {
      std::vector<std::string> names = collected(archive.results.rows, &evaluation::Row::pipeline);
      if (std::find(names.begin(), names.end(), pipeline) != names.end()) continue;
      throw scenarios::InputError(fmt::format("--pipelines: found '{}', allowed for {}: {}",
                                              pipeline, archive.path, fmt::join(names, ", ")));
    }
  }
}

// Beside the archive, by its name: a folder is written anew by the next run.
std::string output_beside(const std::vector<std::string>& archives) {
  if (archives.size() > 1) {
    throw scenarios::InputError(
        fmt::format("--output: found none for {} archives, allowed: a name such as both.html",
                    archives.size()));
  }
  fs::path path = fs::path(archives.front()).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // results/monday/
  if (path == "." || path.filename() == "..") path = fs::canonical(path);
  if (fs::is_directory(path)) return path.string() + ".html";
  return path.replace_extension(".html").string();
}

int make_report(ReportOptions options) {
  check_named_once(options.archives);
  if (options.output.empty()) options.output = output_beside(options.archives);
  std::vector<reports::Archive> archives = collected(options.archives, reports::read_archive);
  check_pipelines(options.detail, archives);
  reports::OutputFile file(options.output);

  reports::ReportInput input{.archives = {}, .command = options.command};
  for (reports::Archive& archive : archives) {
    const app::ReportDetail detail = bounded(options.detail, archive, archives.size());
    auto reported = watched<reports::ReportedArchive>([&](const evaluation::Progress& progress) {
      return app::with_figures(std::move(archive), detail, progress);
    });
    if (!reported) return kInterrupted;
    print_warnings(reported->notes);
    const std::string bounds = app::detail_note(reported->archive, detail);
    if (!bounds.empty()) reported->notes.insert(reported->notes.begin(), bounds);
    input.archives.push_back(std::move(*reported));
  }
  const std::string html = reports::html_report(input);
  file.write(html);
  file.publish();
  print_note(fmt::format("report written to {} ({:.1f} MB)", options.output,
                         static_cast<double>(html.size()) / 1e6));
  return kOk;
}

}  // namespace

void add_report_command(CommandLine& line) {
  auto options = std::make_shared<ReportOptions>();
  options->command = line.arguments;
  Command command(line, "report", "Make one HTML file of result archives: tables and figures");
  command
      .texts("archives", "ARCHIVE...", options->archives,
             "Folders that `simbench run --output` wrote, or a results.json alone")
      .required();
  command.output("-o,--output", "FILE.html", options->output,
                 "The file. Replaces an earlier one. Default for one archive: beside it,\n"
                 "results/monday.html of results/monday");
  command.whole_number("--seeds-in-detail", "N", options->detail.seeds, 1, kMostSeedsInDetail,
                       "How many seeds to show with stamps, clocks and single pulses.\n"
                       "Default: 4, fewer with more than 8 pipelines");
  command.whole_number(
      "--budget-seeds", "N", options->detail.budget_seeds, 0, kMostSeedsInDetail,
      "Seeds of the error budgets (136 runs for each seed and pipeline); 0: none.\n"
      "Default: 4, fewer with more than 8 pipelines");
  command.list("--pipelines", "PIPELINE,...", options->detail.pipelines,
               "Show only these pipelines in detail; the tables have all");
  command.json_messages();
  command.footer(kReportExamples);
  command.runs([options] { return make_report(*options); });
}

}  // namespace simbench::cli
