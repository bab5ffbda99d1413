#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "reports/comparison/gate.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

constexpr const char* kGateExamples = R"(
Exact mode needs the seeds and the scenario of the baseline. It fails if a value of the table is
worse by more than its margin: a share plus a step, stated in the baseline file. Statistical mode
takes any 32 seeds. It fails if a mean is worse by more than the margin and its interval,
Holm-corrected over all metrics, excludes zero.

Examples:
  simbench run --scenario 18cam_6host_45fps --output results
  simbench gate results --baseline reports/baselines/18cam_6host_45fps.json
  simbench gate results --baseline mine.json --mode statistical --junit gate.xml
  simbench gate results --baseline mine.json --junit gate.xml --markdown gate.md      in CI
  simbench gate results --save-baseline mine.json     keeps the margins of an earlier file

Exit status: 0 passed, 1 internal error, 2 bad usage or input, 3 gate failed, 4 baseline missing.)";

struct GateOptions {
  std::string result;
  std::string baseline;
  std::string save_baseline;
  std::string mode = "exact";
  std::string format;
  std::string junit;
  std::string markdown;
};

int save_baseline(const GateOptions& options) {
  reports::Baseline baseline = reports::make_baseline(reports::read_archive(options.result));
  if (std::filesystem::exists(options.save_baseline)) {
    baseline.margins = reports::read_baseline(options.save_baseline).margins;
  }
  reports::write_baseline(baseline, options.save_baseline);
  print_note(fmt::format("baseline written to {}", options.save_baseline));
  return kOk;
}

std::string report_text(const reports::GateReport& report, const std::string& format) {
  if (format == "json") return reports::gate_json(report);
  if (format == "junit") return reports::gate_junit(report);
  if (format == "markdown") return reports::gate_markdown(report);
  return reports::gate_text(report);
}

int gate(const GateOptions& options) {
  if (options.baseline.empty() == options.save_baseline.empty()) {
    throw scenarios::InputError(
        "either --baseline FILE, to compare with it, or --save-baseline FILE, to write one");
  }
  if (!options.save_baseline.empty()) return save_baseline(options);
  if (!std::filesystem::exists(options.baseline)) {
    print_error(
        fmt::format("--baseline {}: no such file", options.baseline),
        fmt::format("simbench gate {} --save-baseline {}", options.result, options.baseline));
    return kBaselineMissing;
  }
  const reports::GateMode mode =
      options.mode == "statistical" ? reports::GateMode::kStatistical : reports::GateMode::kExact;
  const reports::Baseline baseline = reports::read_baseline(options.baseline);
  const reports::GateReport report =
      reports::gate(reports::read_archive(options.result), baseline, mode);
  if (!options.junit.empty()) {
    reports::write_file(options.junit, reports::gate_junit(report));
  }
  if (!options.markdown.empty()) {
    reports::write_file(options.markdown, reports::gate_markdown(report));
  }
  print_result_in(options.format,
                  [&report](const std::string& format) { return report_text(report, format); });
  return report.passed() ? kOk : kGateFailed;
}

}  // namespace

void add_gate_command(CommandLine& line) {
  auto options = std::make_shared<GateOptions>();
  Command command(line, "gate",
                  "Compare a result with a baseline: exit status 3 if it became worse");
  command
      .text("result", "ARCHIVE", options->result,
            "An archive that `simbench run --output` wrote, or a results.json")
      .required();
  command.text("--baseline", "FILE", options->baseline, "The baseline to compare with");
  command.output("--save-baseline", "FILE", options->save_baseline,
                 "Write the result as a baseline; keeps the margins of an earlier one there");
  command.word("--mode", "MODE", options->mode, {"exact", "statistical"},
               "One of: exact, statistical. Default: exact");
  command.format(options->format, {"text", "markdown", "json", "junit"});
  command.output("--junit", "FILE", options->junit, "Write JUnit XML to this file as well");
  command.output("--markdown", "FILE", options->markdown,
                 "Write Markdown to this file as well, for a page of the change");
  command.footer(kGateExamples);
  command.runs([options] { return gate(*options); });
}

}  // namespace simbench::cli
