#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "app/interrupt.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/mask_options.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "reports/page/watch_page.h"
#include "scenarios/loader.h"
#include "server/guard.h"
#include "server/local_server.h"
#include "watch/hook.h"
#include "watch/monitor.h"
#include "watch/open_metrics.h"
#include "watch/watch_text.h"

namespace simbench::cli {
namespace {

using watch::Monitor;
using watch::WatchEvent;

constexpr const char* kWatchExamples = R"(
Follows files that grow, says what diagnose and stability would, and since when: CSV recordings as
`simbench diagnose` takes them, logs of clocks as `simbench stability` takes them ("-" is standard
input), and what a command prints that asks a daemon. It goes on when files are truncated or
rotated, vanish or come back. A camera that slips is known within 2 s, a clock that steps with the
second sample.

On a terminal it shows the state; elsewhere, and with --format json, a line of JSON for each event.

Examples:
  simbench watch rig.csv
  simbench watch front.csv back.csv --clock-log hostA=/var/log/chrony/tracking.log
  ptp4l -m -i eth0 | simbench watch --clock-log -
  simbench watch --clock-command 'chronyc -c -n tracking' --limit-ms 0.5
  simbench watch monday                               what simbench record writes, of a real rig
  simbench watch rig.csv --format json --on-event 'logger "$SIMBENCH_EVENT_TEXT"'
  simbench watch --clock-log ptp4l.txt --mask class_b  what stability says of the last 4096 errors
  simbench watch rig.csv --page                       the same in a browser, and for Prometheus
  simbench watch rig.csv --for-s 3600 --until-alarm   in a script: how did the hour end?

Exit status: 0 no alarm, 3 there was an alarm, 1 internal error, 2 bad usage or input.)";

struct WatchArguments {
  std::vector<std::string> recordings;
  InputOptions reading;
  std::vector<std::string> clock_logs;
  std::vector<std::string> clock_commands;
  std::optional<double> limit_ms;
  MaskOptions limits;
  double interval_s = 0.5;
  std::optional<double> for_s;
  bool until_alarm = false;
  std::string format;
  std::string hook;
  bool page = false;
  std::uint64_t port = 0;
  std::string token_file;
};

// "hostA=tracking.log" or the path alone; a path may have "=" only behind a "/".
watch::WatchedLog watched_log(const std::string& text, bool is_command) {
  const std::size_t mark = text.find('=');
  const bool is_named = mark != std::string::npos && mark > 0 && text.find_first_of("/ '\"") > mark;
  if (!is_named) return {.path = text, .is_command = is_command};
  return {.host = text.substr(0, mark), .path = text.substr(mark + 1), .is_command = is_command};
}

watch::WatchOptions watch_options(const WatchArguments& arguments) {
  watch::WatchOptions options{.recordings = arguments.recordings,
                              .columns = file_options(arguments.reading).columns,
                              .clock_limit_ms = arguments.limit_ms,
                              .clock_masks = masks_of(arguments.limits)};
  for (const std::string& log : arguments.clock_logs) {
    options.clock_logs.push_back(watched_log(log, false));
  }
  for (const std::string& command : arguments.clock_commands) {
    options.clock_logs.push_back(watched_log(command, true));
  }
  if (options.recordings.empty() && options.clock_logs.empty()) {
    throw scenarios::InputError(
        "found nothing to watch, allowed: CSV recordings, --clock-log or --clock-command");
  }
  return options;
}

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// What is shown while it goes on: a state that is drawn over itself, or a line for each event.
class WatchView {
 public:
  explicit WatchView(const std::string& format)
      : draws_(format != "json" && progress_style().terminal) {}

  void show(const Monitor& monitor, const std::vector<WatchEvent>& events) {
    if (draws_) {
      print_result("\x1b[H\x1b[J" + watch::watch_text(monitor.snapshot()));
      return;
    }
    for (const WatchEvent& event : events) {
      print_result(event_json(event).dump(-1, ' ', false, reports::Json::error_handler_t::replace) +
                   "\n");
    }
  }

 private:
  bool draws_;
};

class Watching {
 public:
  explicit Watching(const WatchArguments& arguments)
      : arguments_(arguments),
        monitor_(watch_options(arguments)),
        hook_(arguments.hook),
        view_(arguments.format),
        begin_s_(steady_s()) {}

  // Whether it goes on.
  bool poll() {
    const std::vector<WatchEvent> events = monitor_.poll(steady_s());
    for (const WatchEvent& event : events) hook_.tell(event);
    hook_.look();
    view_.show(monitor_, events);
    if (arguments_.until_alarm && monitor_.had_alarm()) return false;
    return !arguments_.for_s || steady_s() - begin_s_ < *arguments_.for_s;
  }

  int finish() {
    hook_.finish();
    if (hook_.failed() + hook_.dropped() > 0) {
      print_note(fmt::format("--on-event: {} ended with an error, {} events were dropped",
                             hook_.failed(), hook_.dropped()));
    }
    return monitor_.had_alarm() ? kGateFailed : kOk;
  }

  const Monitor& monitor() const { return monitor_; }
  std::chrono::milliseconds interval() const {
    return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * arguments_.interval_s));
  }

 private:
  const WatchArguments& arguments_;
  Monitor monitor_;
  watch::Hook hook_;
  WatchView view_;
  double begin_s_;
};

void watch_alone(Watching& watching) {
  const app::InterruptHandler handler;
  while (!app::InterruptHandler::raised() && watching.poll()) {
    std::this_thread::sleep_for(watching.interval());
  }
}

server::PageResponse answered(const Monitor& monitor, const server::PageRequest& request) {
  if (request.path.empty()) {
    return {.type = "text/html; charset=utf-8", .body = reports::watch_html()};
  }
  if (request.path == "snapshot") {
    return {
        .type = "application/json",
        .body = monitor.snapshot().dump(-1, ' ', false, reports::Json::error_handler_t::replace)};
  }
  if (request.path == "metrics") {
    return {.type = watch::kOpenMetricsType, .body = watch::open_metrics(monitor.snapshot())};
  }
  return {.status = 404, .body = "there is no such page\n"};
}

std::string token_of(const std::string& file) {
  try {
    return file.empty() ? std::string() : server::token_in(file);
  } catch (const std::runtime_error& failure) {
    throw scenarios::InputError(std::string("--token-file ") + failure.what());
  }
}

void watch_with_page(Watching& watching, const WatchArguments& arguments) {
  server::LocalServer server(
      {.port = static_cast<std::uint16_t>(arguments.port),
       .token = token_of(arguments.token_file),
       .stops_on_signals = true},
      [&](const server::PageRequest& request) { return answered(watching.monitor(), request); });
  print_note(fmt::format("open {} in a browser on this machine; {}metrics is for Prometheus",
                         server.address(), server.address()));
  const std::function<void()> poll = [&] {
    if (watching.poll()) {
      server.after(watching.interval(), poll);
    } else {
      server.stop();
    }
  };
  poll();
  server.run();
}

int run_watch(const WatchArguments& arguments) {
  Watching watching(arguments);
  if (arguments.page) {
    watch_with_page(watching, arguments);
  } else {
    watch_alone(watching);
  }
  return watching.finish();
}

}  // namespace

void add_watch_command(CommandLine& line) {
  auto options = std::make_shared<WatchArguments>();
  Command command(line, "watch", "Watch cameras and clocks while their files grow");
  command.texts("recordings", "INPUT...", options->recordings,
                "CSV recordings that are appended to, as `simbench diagnose` takes them, and "
                "folders\nthat `simbench record` is writing");
  add_input_options(command, options->reading);
  command.texts("--clock-log", "[HOST=]FILE", options->clock_logs,
                "A log of a host's clock that is appended to, of any form that `simbench "
                "stability`\nreads; \"-\": standard input; may be given several times");
  command.texts("--clock-command", "[HOST=]COMMAND", options->clock_commands,
                "A command that prints a clock's error, run once a second, such as\n"
                "'chronyc -c -n tracking'");
  command.number("--limit-ms", "MS", options->limit_ms, 0, 1e9,
                 "An error of a clock beyond this is an alarm");
  add_mask_options(command, options->limits);
  command.number("--interval-s", "S", options->interval_s, 0.05, 60,
                 "How often the files are read. Default: 0.5");
  command.number("--for-s", "S", options->for_s, 0, 1e9, "End after this time");
  command.flag("--until-alarm", options->until_alarm, "End with the first alarm");
  command.text("--on-event", "COMMAND", options->hook,
               "Run this by the shell for each event, with SIMBENCH_EVENT (JSON) and\n"
               "SIMBENCH_EVENT_KIND, _SUBJECT and _TEXT");
  command.flag("--page", options->page,
               "Also serve a page of it, and its metrics for Prometheus, on this machine alone");
  command.whole_number("--port", "PORT", options->port, 0, 65535,
                       "With --page: the port. Default: a free one");
  command.text("--token-file", "FILE", options->token_file,
               "With --page: keep the secret of the address in this file, so that Prometheus finds "
               "it\nagain. It is made, for its owner alone, if it is not there");
  command.format(options->format, {"table", "json"});
  command.footer(kWatchExamples);
  command.runs([options] { return run_watch(*options); });
}

}  // namespace simbench::cli
