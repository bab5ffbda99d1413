#include <fmt/format.h>

#include <memory>
#include <system_error>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/messages.h"
#include "explore/explorer.h"
#include "scenarios/document.h"
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

Exit status: 0 ended by Ctrl-C, 1 internal error, 2 bad usage or input.)";

struct ExploreOptions {
  std::string subject = kDefaultScenario;
  std::vector<std::string> sets;
  std::uint64_t port = 0;
};

explore::PageSubject subject_of(const ExploreOptions& options) {
  explore::PageSubject subject{.name = options.subject, .sets = overrides_of(options.sets)};
  const scenarios::Scenario world =
      scenarios::load_scenario(options.subject, overrides_of(options.sets));
  print_warnings(scenarios::warnings(world));
  if (options.subject.ends_with(".json")) {
    subject.text = scenarios::read_input_file(options.subject, options.subject, "scenario");
  }
  return subject;
}

int explore_by_hand(const ExploreOptions& options) {
  explore::Explorer explorer(subject_of(options));
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
  command.text("scenario", "SCENARIO", options->subject,
               "Name of a scenario, or path of a scenario file. Default: 18cam_6host_45fps");
  command.sets(options->sets);
  command.whole_number("--port", "PORT", options->port, 0, 65535,
                       "The port to listen on. Default: a free one");
  command.footer(kExploreExamples);
  command.runs([options] { return explore_by_hand(*options); });
}

}  // namespace simbench::cli
