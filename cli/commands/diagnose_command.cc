#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/host_logs.h"
#include "app/pack.h"
#include "app/recorded_streams.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/messages.h"
#include "evaluation/diagnosis/diagnose.h"
#include "reports/page/diagnose_page.h"
#include "reports/recordings/diagnose_report.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

constexpr double kLowestRateHz = 0.01;
constexpr double kHighestRateHz = 10'000;

constexpr const char* kDiagnoseExamples = R"(
Takes the recordings that `simbench replay` takes: bags of the RealSense SDK, of ROS 1 and of ROS 2
(MCAP, SQLite), CSV files, or a recording folder, of which it diagnoses the first capture. Several
files are one rig. A minute is enough to tell cameras that run free from cameras that follow a
trigger.

Examples:
  simbench diagnose front.bag back.bag --html rig.html
  simbench diagnose rig.mcap --topics /left/image_raw,/right/image_raw
  simbench diagnose log.csv --columns sensor=t_camera:us,arrival=t_host:s,camera=id
  simbench diagnose rig.csv
  simbench diagnose results/monday                     a folder of `simbench record`
  simbench diagnose front.csv back.csv --one-host      both recorded on one computer
  simbench diagnose rig.csv --html rig.html            the same as a page
  simbench diagnose *.bag --clock-log hostA=ptp4l.log --clock-log hostB=tracking.log
  simbench diagnose *.bag --pack for_you               stamps without images and names
  simbench diagnose rig.csv --rate-hz 30 --format json > diagnosis.json

Exit status: 0 ok, for any diagnosis, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct DiagnoseArguments {
  std::vector<std::string> files;
  InputOptions inputs;
  std::string format;
  std::optional<double> rate_hz;
  bool one_host = false;
  std::vector<std::string> clock_logs;
  std::string html;
  std::string pack;
  std::vector<std::string> command;
};

// What somebody else may see of the recording.
void write_pack(const DiagnoseArguments& options, const RecordedStreams& rig,
                const std::vector<evaluation::HostLog>& logs) {
  const auto folder = app::recording_folder_of(options.files);
  const app::Pack packed = folder ? app::pack_recording(*folder, options.pack)
                                  : app::pack_streams(rig, logs, options.pack);
  for (const std::string& note : packed.notes) print_note(note);
  print_note(options.pack + " written: no images, no names; the times are as recorded");
}

int run_diagnose(const DiagnoseArguments& options) {
  std::optional<reports::OutputFile> page;  // refuses before the work what cannot be written
  if (!options.html.empty()) page.emplace(options.html);
  const auto rig = read_inputs(options.files, options.inputs);
  if (!rig) return kInterrupted;
  app::HostLogs clocks = app::host_logs(options.clock_logs);
  for (const std::string& note : clocks.notes) print_note(note);
  if (!options.pack.empty()) write_pack(options, *rig, clocks.logs);
  const evaluation::Diagnosis diagnosis =
      evaluation::diagnose(rig->streams, {.rate_hz = options.rate_hz,
                                          .one_host = options.one_host,
                                          .clock_logs = std::move(clocks.logs)});
  print_result(options.format == "json" ? reports::diagnose_json(diagnosis, options.files)
                                        : plain(reports::diagnose_document(diagnosis)));
  if (page) {
    page->write(reports::diagnose_html(
        {.diagnosis = diagnosis, .inputs = options.files, .command = options.command}));
    page->publish();
    print_note(options.html + " written");
  }
  return kOk;
}

}  // namespace

void add_diagnose_command(CommandLine& line) {
  auto options = std::make_shared<DiagnoseArguments>();
  options->command = line.arguments;
  Command command(line, "diagnose", "Find out whether the hardware sync of a recorded rig works");
  command.texts("inputs", "INPUT...", options->files, kInputsText).required();
  command.format(options->format, {"table", "json"});
  command.number("--rate-hz", "HZ", options->rate_hz, kLowestRateHz, kHighestRateHz,
                 "The trigger's rate. Default: the rate of most cameras");
  add_input_options(command, options->inputs);
  command.flag("--one-host", options->one_host,
               "One computer stamped all arrivals, even if the files name several hosts");
  command.texts(
      "--clock-log", "[HOST=]FILE", options->clock_logs,
      "A log of a host's clock, of any form that `simbench stability` reads; may be given\n"
      "several times. What of the cameras' spread the clocks are, and what not");
  command.output("--html", "FILE.html", options->html,
                 "Write a page, too: the answer, how each camera's phase moves, the tables. It\n"
                 "is one file, which opens offline");
  command.output("--pack", "DIR", options->pack,
                 "Write the stamps, too, for somebody else to look at: a new folder without\n"
                 "images, names and paths, of which `simbench diagnose` says the same");
  command.footer(kDiagnoseExamples);
  command.runs([options] { return run_diagnose(*options); });
}

}  // namespace simbench::cli
