#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/progress.h"
#include "evaluation/advice/advice.h"
#include "reports/advice/advice_report.h"
#include "reports/text/json_node.h"
#include "scenarios/document.h"

namespace simbench::cli {
namespace {

constexpr const char* kAdviseExamples = R"(
Examples:
  simbench advise --require 'amd<0.1ms' --cameras 24 --rate 60
  simbench advise --require 'error<0.2ms' --require 'recall>99%' --cameras 12 --rate 30 --hosts 2..4
  simbench advise --require 'amd<1ms' --cameras 18 --rate 45 --parts my_switch.json --format json
  simbench advise --require 'amd<0.1ms' --cameras 24 --rate 60 --set /network/cross_traffic_share=0.3

A requirement is a metric, < or >, and a value with its unit. Rigs are put together from the parts
of `simbench list parts` in a nominal world, and simulated; prices are rough classes. The answer
comes first, then every rig from the cheapest on, then what was assumed.

Exit status: 0 ok (also if no rig meets it), 1 internal error, 2 bad usage or input,
130 interrupted.)";

constexpr std::int64_t kMostHosts = 24;

struct AdviseOptions {
  std::vector<std::string> require;
  evaluation::AdviceRequest request;
  evaluation::AdviceOptions advice;
  std::string hosts;
  std::vector<std::string> parts;
  std::vector<std::string> sets;
  std::string format;
};

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  if (!is_whole || number < 1 || number > kMostHosts) return std::nullopt;
  return number;
}

// "2..8" or "4"; nothing given: all that makes sense.
void set_hosts(const std::string& text, evaluation::RigRequest& rig) {
  if (text.empty()) return;
  const std::size_t dots = text.find("..");
  const auto low = whole_number(std::string_view(text).substr(0, dots));
  const auto high =
      dots == std::string::npos ? low : whole_number(std::string_view(text).substr(dots + 2));
  if (!low || !high || *low > *high) {
    throw scenarios::InputError(
        fmt::format("--hosts: found '{}', allowed: a number or a range FEWEST..MOST from 1 to {}, "
                    "as in 2..8",
                    scenarios::shown_text(text), kMostHosts));
  }
  rig.fewest_hosts = *low;
  rig.most_hosts = *high;
}

void add_parts(const std::vector<std::string>& files, evaluation::RigRequest& rig) {
  for (const std::string& file : files) {
    scenarios::Part part = scenarios::load_part(file);
    const auto is_same = [&part](const scenarios::Part& other) { return other.part == part.part; };
    if (scenarios::find_part(part.part) != nullptr ||
        std::ranges::any_of(rig.more_parts, is_same)) {
      throw scenarios::InputError(fmt::format(
          "{}: /part: found \"{}\", allowed a name that no other part has (simbench list parts)",
          file, part.part));
    }
    rig.more_parts.push_back(std::move(part));
  }
}

int advise(AdviseOptions options) {
  options.request.requirements = evaluation::parse_requirements(options.require);
  evaluation::RigRequest& rig = options.request.rig;
  set_hosts(options.hosts, rig);
  add_parts(options.parts, rig);
  rig.sets = overrides_of(options.sets);
  const auto advice = watched<evaluation::Advice>(
      [&](const evaluation::Progress& progress) {
        return evaluation::advise(options.request, app::simulated_world, options.advice, progress);
      },
      {.unit = "step"});
  if (!advice) return kInterrupted;
  if (options.format == "json") {
    print_result(reports::file_text(reports::advice_json(*advice)));
  } else {
    const reports::Document document = reports::advice_document(*advice);
    print_result(options.format == "markdown" ? markdown(document) : plain(document));
  }
  return kOk;
}

}  // namespace

void add_advise_command(CommandLine& line) {
  auto options = std::make_shared<AdviseOptions>();
  evaluation::RigRequest& rig = options->request.rig;
  Command command(line, "advise",
                  "Which rigs of real parts meet a requirement, the cheapest first");
  command
      .texts("--require", "METRIC<VALUE", options->require,
             "What the rig must do, repeatable: 'amd<0.1ms', 'error<50us', 'recall>99%',\n"
             "'host_error<10us', ... All must hold at once")
      .required();
  command
      .whole_number("--cameras", "N", rig.cameras, 1, evaluation::kMostAdviceCameras,
                    "Cameras of the rig")
      .required();
  command.number("--rate", "HZ", rig.rate_hz, 1, 1000, "Frames a second. Default: 30");
  command.text("--hosts", "FEWEST..MOST", options->hosts,
               "How many hosts to try, as in 2..8 or 4. Default: 1..8");
  command.texts("--parts", "FILE", options->parts,
                "A part of your own, repeatable: a file as those of `simbench list parts`");
  command.sets(options->sets);
  command.count("--seeds", options->advice.seeds,
                "Simulated rigs behind an answer. Default: 72, so that all of them meeting it\n"
                "means a probability of at least 95 %");
  command.seed("--first-seed", options->advice.first_seed, "The first seed. Default: 1");
  command.jobs(options->advice.jobs);
  command.format(options->format, {"table", "markdown", "json"});
  command.footer(kAdviseExamples);
  command.runs([options] { return advise(*options); });
}

}  // namespace simbench::cli
