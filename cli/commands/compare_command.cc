#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/messages.h"
#include "reports/comparison/comparison.h"
#include "reports/page/compare_page.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

constexpr const char* kCompareExamples = R"(
With two archives A and B: compares the pipelines of the same name, B against A. With one archive:
compares the second of two pipelines with the first, or every pipeline with one of them ("how much
better than NTP?").

Examples:
  simbench compare results/monday results/tuesday
  simbench compare results/monday --with-baseline ntp_last_set
  simbench compare results/monday --pipelines yoon2021_network,yoon2021_both --format json
  simbench compare results/monday results/tuesday --html both.html

Exit status: 0 ok, for any verdict (`simbench gate` judges), 1 internal error, 2 bad usage or
input.)";

struct CompareOptions {
  std::vector<std::string> archives;
  std::string baseline;
  std::string format;
  double smallest_effect_percent = 5;
  reports::ComparisonOptions comparison;
  std::string html;
  std::vector<std::string> command;
};

reports::Comparison compared(const CompareOptions& options) {
  const std::vector<std::string>& pipelines = options.comparison.pipelines;
  const bool with_baseline = !options.baseline.empty();
  if (options.archives.size() == 2) {
    if (with_baseline) {
      throw scenarios::InputError(
          "--with-baseline: found two archives, allowed: one, whose pipelines are compared");
    }
    return reports::compare_archives(reports::read_archive(options.archives[0]),
                                     reports::read_archive(options.archives[1]),
                                     options.comparison);
  }
  if (with_baseline == !pipelines.empty()) {
    throw scenarios::InputError(
        "found one archive, allowed with it: either --pipelines X,Y or --with-baseline PIPELINE; "
        "or name a second archive");
  }
  const reports::Archive archive = reports::read_archive(options.archives[0]);
  if (with_baseline) {
    return reports::compare_with_baseline(archive, options.baseline, options.comparison);
  }
  if (pipelines.size() != 2) {
    throw scenarios::InputError(
        fmt::format("--pipelines: found {} names, allowed for one archive: two", pipelines.size()));
  }
  return reports::compare_pipelines(archive, pipelines[0], pipelines[1], options.comparison);
}

int compare(CompareOptions options) {
  std::optional<reports::OutputFile> page;  // refuses before the work what cannot be written
  if (!options.html.empty()) page.emplace(options.html);
  options.comparison.smallest_effect = options.smallest_effect_percent / 100;
  const reports::Comparison comparison = compared(options);
  print_result(options.format == "json" ? reports::comparison_json(comparison)
               : options.format == "csv"
                   ? reports::comparison_csv(comparison)
                   : reports::drawn_as(options.format, reports::comparison_document(comparison)));
  if (page) {
    page->write(reports::compare_html(comparison, options.command));
    page->publish();
    print_note(options.html + " written");
  }
  return kOk;
}

}  // namespace

void add_compare_command(CommandLine& line) {
  auto options = std::make_shared<CompareOptions>();
  options->command = line.arguments;
  Command command(line, "compare",
                  "Compare two result archives, or pipelines of one, seed by seed");
  command
      .texts("archives", "ARCHIVE...", options->archives,
             "One or two archives that `simbench run --output` wrote, or results.json files")
      .required()
      .at_most(2);
  command.list("--pipelines", "PIPELINE,...", options->comparison.pipelines,
               "With one archive: the two to compare. With two: only these");
  command.text("--with-baseline", "PIPELINE", options->baseline,
               "Compare each other pipeline of the archive with this one");
  command.number("--smallest-effect", "PERCENT", options->smallest_effect_percent, 0, 1000,
                 "The smallest difference that matters, in percent of A's mean: decides between\n"
                 "'no difference seen' and 'too few seeds'. Default: 5");
  command.flag("--by-index", options->comparison.by_index,
               "Pair the n-th seed of A with the n-th of B: for archives without common seeds");
  command.flag("--different-scenarios", options->comparison.different_scenarios,
               "Compare the same pipelines in worlds that differ");
  command.format(options->format, {"table", "markdown", "latex", "csv", "json"});
  command.output(
      "--html", "FILE.html", options->html,
      "Write a page, too: the verdicts, A and B side by side, their differences seed by\n"
      "seed. It is one file, which opens offline");
  command.footer(kCompareExamples);
  command.runs([options] { return compare(*options); });
}

}  // namespace simbench::cli
