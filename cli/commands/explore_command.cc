#include <fmt/format.h>

#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "evaluation/fit/fit.h"
#include "explore/demo.h"
#include "explore/explorer.h"
#include "explore/subject.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"
#include "server/local_server.h"

namespace simbench::cli {
namespace {

constexpr const char* kDefaultScenario = "18cam_6host_45fps";

constexpr const char* kExploreExamples = R"(
Prints an address for a browser on this machine. Every parameter of the world has a slider; the
answer, the tables and the figures follow, first of 8 seeds, then of more. Whatever it shows is what
`simbench run` prints of the same; a button gives the command, the scenario file and the Python.

The server listens on this machine alone, and answers only who knows the address.

Examples:
  simbench explore
  simbench explore 3cam_1host_30fps
  simbench explore my_rig.json --port 8000
  simbench explore results/monday                  the world of an archive
  simbench explore front.bag back.bag              a rig that was recorded, fitted to it
  simbench explore --export demo.html              one file to show others, without a server
  simbench explore 3cam_1host_30fps --export tour.html --sweep /cameras/exposure_ms=2,8,20

Exit status: 0 ended by Ctrl-C, 1 internal error, 2 bad usage or input.)";

struct ExploreOptions {
  std::vector<std::string> inputs;
  InputOptions reading;
  std::vector<std::string> sets;
  std::uint64_t port = 0;
  std::string exported;
  explore::DemoRequest demo;
};

// Nothing after Ctrl-C.
std::optional<explore::FoundSubject> found_subject(const ExploreOptions& options) {
  const explore::SubjectChoice choice{.sets = overrides_of(options.sets),
                                      .files = file_options(options.reading)};
  std::vector<std::string> inputs = options.inputs;
  if (inputs.empty()) inputs.emplace_back(kDefaultScenario);
  return watched_reading<explore::FoundSubject>(
      [&](const ReadProgress& progress) { return explore::subject_of(inputs, choice, progress); });
}

int export_demo(const ExploreOptions& options, const explore::PageSubject& subject) {
  reports::OutputFile file(options.exported);
  explore::DemoRequest request = options.demo;
  if (request.axes.empty()) request.axes = explore::usual_axes();
  const auto html = watched<std::string>(
      [&](const evaluation::Progress& progress) {
        return explore::demo_html(subject, request, progress);
      },
      {.unit = "world"});
  if (!html) return kInterrupted;
  file.write(*html);
  file.publish();
  print_note(fmt::format("{} written ({:.1f} MB)", options.exported,
                         static_cast<double>(html->size()) / 1e6));
  return kOk;
}

int explore_by_hand(const ExploreOptions& options) {
  std::optional<explore::FoundSubject> found;
  try {
    found = found_subject(options);
  } catch (const evaluation::FitError& error) {
    throw scenarios::InputError(error.what());
  }
  if (!found) return kInterrupted;
  for (const std::string& note : found->notes) print_note(note);
  if (!options.exported.empty()) return export_demo(options, found->subject);
  explore::Explorer explorer(std::move(found->subject));
  try {
    server::LocalServer server(
        {.port = static_cast<std::uint16_t>(options.port), .stops_on_signals = true},
        [&](const server::PageRequest& request) { return explorer.answer(request); });
    print_result(
        fmt::format("Open {} in a browser on this machine. Ctrl-C ends it.\n", server.address()));
    server.run();
  } catch (const std::system_error& failure) {
    throw scenarios::InputError(
        fmt::format("--port: found {}, which cannot be listened on: {}; allowed: a free port, or "
                    "none for any",
                    options.port, failure.code().message()));
  }
  return kOk;
}

}  // namespace

void add_explore_command(CommandLine& line) {
  auto options = std::make_shared<ExploreOptions>();
  Command command(line, "explore", "Change a world by hand in a browser and see what follows");
  command.texts("subject", "SCENARIO", options->inputs,
                "A scenario by name or file, the folder of `simbench run --output`, or a recording "
                "as\n`simbench fit` takes it, which is fitted. Default: 18cam_6host_45fps");
  command.sets(options->sets);
  add_input_options(command, options->reading);
  command.whole_number("--port", "PORT", options->port, 0, 65535,
                       "The port to listen on. Default: a free one");
  command.output("--export", "FILE.html", options->exported,
                 "Write one page that needs no server, in place of serving: a grid of worlds that "
                 "are\ncomputed now, over the parameters of --sweep");
  command.texts("--sweep", "/POINTER=VALUES", options->demo.axes,
                "With --export: a parameter and its values, as `simbench sweep` takes them; one to "
                "five\ntimes. Default: USB jitter, network latency and exposure");
  command.whole_number("--seeds", "N", options->demo.seeds, 1, explore::kMostSeeds,
                       "With --export: seeds of each world. Default: 16");
  command.footer(kExploreExamples);
  command.runs([options] { return explore_by_hand(*options); });
}

}  // namespace simbench::cli
