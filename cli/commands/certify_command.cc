#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/exchange_logs.h"
#include "app/interrupt.h"
#include "app/recordings.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/progress.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/certificate_run.h"
#include "recording/counted.h"
#include "recording/duration_in.h"
#include "reports/certificates/certificate_report.h"
#include "reports/text/output_file.h"
#include "scenarios/document.h"

namespace simbench::cli {
namespace {

constexpr const char* kCertifyExamples = R"(
For each gathered set the interval that surely holds how far its frames were exposed from each
other, given what is assumed: bounds of the clocks' rates, and that nothing arrives before it was
sent. It follows from the messages between the hosts, the polls of the cameras' clocks and the
arrivals of frames, and no method can give a smaller one from them. Facts that contradict each
other prove an assumption wrong, and are named.

Takes a scenario, whose simulated captures have the truth beside it, or a folder that
`simbench record` wrote.

Examples:
  simbench certify 18cam_6host_45fps_lan --pipelines two_way_hull,chrony
  simbench certify monday --within 0.5ms --require 95
  simbench certify monday --host-rate-ppm 20 --camera-rate-ppm 20 --causal
  simbench certify 18cam_6host_45fps_lan --common-trigger --trigger-spread-us 50 --json

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 3 fewer sets than --require are
within --within, 130 interrupted.)";

struct CertifyOptions {
  std::string input;
  evaluation::CertificateOptions certificates;
  std::vector<std::string> sets;
  std::string within;
  std::string pairs;
  std::vector<std::string> clock_logs;
  std::vector<std::string> host_addresses;
  std::optional<double> required_percent;
  std::optional<double> host_rate_ppm, camera_rate_ppm, message_ms, poll_ms, arrival_ms,
      host_stamp_ms, estimated_stamp_ms, sensor_stamp_us, trigger_hz, observed_margin_ppm,
      pulse_late_us;
  bool common_trigger = false;
  double trigger_spread_us = 100;
  bool causal = false;
  std::string format;
};

void set_assumptions(const CertifyOptions& options, const scenarios::Scenario& scenario,
                     evaluation::Assumptions& assumed) {
  assumed = evaluation::assumptions_of(scenario);
  const auto set = [](const std::optional<double>& given, double& value) {
    value = given.value_or(value);
  };
  set(options.host_rate_ppm, assumed.host_rate_ppm);
  set(options.camera_rate_ppm, assumed.camera_rate_ppm);
  set(options.message_ms, assumed.message_ms);
  set(options.poll_ms, assumed.poll_ms);
  set(options.arrival_ms, assumed.arrival_ms);
  set(options.host_stamp_ms, assumed.host_stamp_ms);
  set(options.sensor_stamp_us, assumed.sensor_stamp_us);
  assumed.estimated_stamp_ms = options.estimated_stamp_ms;
  assumed.observed_margin_ppm = options.observed_margin_ppm;
  assumed.pulse_late_us = options.pulse_late_us;
  if (!options.common_trigger) return;
  const double rate_hz = options.trigger_hz.value_or(scenario.trigger.pulse_rate_hz());
  assumed.trigger = {.period_ms = 1e3 / rate_hz, .spread_ms = options.trigger_spread_us * 1e-3};
}

double within_ms(const std::string& text) {
  if (text.empty()) return evaluation::CertificateOptions{}.within_ms;
  const std::optional<double> seconds = seconds_in(text);
  if (!seconds) {
    throw scenarios::InputError(fmt::format("--within: found '{}', allowed: {}, as in 1ms",
                                            scenarios::shown_text(text), kDurationAllowed));
  }
  return *seconds * 1e3;
}

std::optional<evaluation::CertificateRun> certify(const scenarios::Scenario& scenario,
                                                  const evaluation::SourceFactory& make_source,
                                                  const CertifyOptions& options) {
  evaluation::CertificateOptions certificates = options.certificates;
  certificates.within_ms = within_ms(options.within);
  certificates.horizon =
      options.causal ? evaluation::Horizon::kCausal : evaluation::Horizon::kWhole;
  certificates.cancel = &app::InterruptHandler::flag();
  set_assumptions(options, scenario, certificates.assumptions);
  return watched<evaluation::CertificateRun>([&](const evaluation::Progress& progress) {
    return evaluation::certify_pipelines(scenario, make_source, certificates, progress);
  });
}

// A log is of one stretch of time, so of one capture.
void check_logs(const CertifyOptions& options, const app::RecordedRun& run) {
  if (options.clock_logs.empty()) return;
  const std::size_t captures = options.certificates.pipelines.size() * run.seeds();
  if (captures <= 1) return;
  throw scenarios::InputError(
      fmt::format("--clock-log: found {}, allowed: one, since a log is of one stretch of time; "
                  "--pipelines chooses it",
                  counted(captures, "capture")));
}

std::optional<evaluation::CertificateRun> certify_recording(CertifyOptions options) {
  app::check_evidence({options.input});
  const app::RecordedRun run = app::recorded_run({options.input}, {}, {});
  evaluation::CertificateOptions& certificates = options.certificates;
  certificates.pipelines = run.chosen(certificates.pipelines);
  certificates.first_seed = run.first_seed();
  certificates.seeds = run.seeds();
  check_logs(options, run);
  app::ExchangeLogs logs = app::exchange_logs(options.clock_logs, options.host_addresses, run);
  for (const std::string& note : logs.notes) print_note(note);
  certificates.logs = std::move(logs.logs);
  certificates.host_of_address = std::move(logs.host_of_address);
  const auto choices = evaluation::choose_pipelines(run.scenario(), certificates.pipelines);
  return certify(
      run.scenario(), [&] { return run.source(choices); }, options);
}

std::optional<evaluation::CertificateRun> certify_scenario(const CertifyOptions& options) {
  if (!options.clock_logs.empty()) {
    throw scenarios::InputError(fmt::format(
        "--clock-log: found the scenario {}, allowed: a folder that `simbench record` wrote",
        scenarios::shown_text(options.input)));
  }
  const scenarios::Scenario scenario = scenarios::load_scenario(
      options.input, evaluation::with_ad_hoc_pipelines(options.input, overrides_of(options.sets),
                                                       options.certificates.pipelines));
  return certify(
      scenario, [&] { return app::simulated_world(scenario); }, options);
}

// Whether all pipelines have as many sets within the bound as are required.
bool meets(const evaluation::CertificateRun& run, double required_percent) {
  return std::ranges::all_of(run.rows, [&](const evaluation::CertificateRow& row) {
    return row.contradicted.empty() && row.problem.empty() &&
           row.share_within() >= required_percent / 100;
  });
}

int run_certify(CertifyOptions options) {
  std::optional<reports::OutputFile> pairs;  // refuses before the work what cannot be written
  if (!options.pairs.empty()) pairs.emplace(options.pairs);
  options.certificates.keep_pairs = pairs.has_value();
  const bool is_recorded =
      app::is_recording(options.input) || std::filesystem::is_directory(options.input);
  const auto run = is_recorded ? certify_recording(options) : certify_scenario(options);
  if (!run) return kInterrupted;
  print_result_in(options.format, [&](const std::string& format) {
    return format == "json" ? reports::file_text(reports::certificate_json(*run))
                            : reports::drawn_as(format, reports::certificate_document(*run));
  });
  if (pairs) {
    pairs->write(reports::pairs_csv(*run));
    pairs->publish();
    print_note(options.pairs + " written");
  }
  const bool is_met = !options.required_percent || meets(*run, *options.required_percent);
  return is_met ? kOk : kGateFailed;
}

void add_assumption_options(Command& command, CertifyOptions& options) {
  constexpr double kMostPpm = evaluation::Assumptions::kMostRate_ppm, kMostMs = 1e5;
  command.number(
      "--host-rate-ppm", "PPM", options.host_rate_ppm, 0, kMostPpm,
      "Assume that each host's oscillator is within +-PPM of true time. Default: 50, or what\n"
      "the scenario's law makes likely, if that is more");
  command.number("--camera-rate-ppm", "PPM", options.camera_rate_ppm, 0, kMostPpm,
                 "The same of each camera's clock");
  command.number(
      "--observed-rates-ppm", "MARGIN", options.observed_margin_ppm, 0, kMostPpm,
      "Assume in place of both that rates against host 0 are within +-MARGIN of what the\n"
      "recording shows: much narrower, but nothing in the recording proves a margin");
  command.number("--message-ms", "MS", options.message_ms, 0, kMostMs,
                 "Least delay of a message between hosts. Default: 0");
  command.number("--poll-ms", "MS", options.poll_ms, 0, kMostMs,
                 "Least delay of either way of a poll of a camera's clock. Default: 0");
  command.number("--arrival-ms", "MS", options.arrival_ms, 0, kMostMs,
                 "Least time from the end of an exposure until its frame arrives. Default: 0");
  command.number("--host-stamp-ms", "MS", options.host_stamp_ms, 0, kMostMs,
                 "Largest error of a host's stamp. Default: the scenario's granularity");
  command.number("--estimated-stamp-ms", "MS", options.estimated_stamp_ms, 0, kMostMs,
                 "Largest error of a stamp that a host_sync estimated (two_way, cards, PTP's\n"
                 "program stamps). Default: exchanges with such stamps prove nothing");
  command.number("--pulse-late-us", "US", options.pulse_late_us, 0, 1e6,
                 "How late a host sees a pulse of its PPS line at most. Default: pulses prove\n"
                 "nothing");
  command.number("--sensor-stamp-us", "US", options.sensor_stamp_us, 0, 1e6,
                 "Largest distance of a sensor stamp from the middle of its exposure. Default: 1\n"
                 "and 8 times the scenario's jitter");
  const Option trigger = command.flag(
      "--common-trigger", options.common_trigger,
      "Assume that pulses of one trigger expose all frames: a difference is then near a\n"
      "whole number of its periods");
  command
      .number("--trigger-hz", "HZ", options.trigger_hz, 1e-3, 1e6,
              "Its rate, within 100 ppm. Default: the scenario's")
      .needs(trigger);
  command
      .number("--trigger-spread-us", "US", options.trigger_spread_us, 0, 1e6,
              "How far exposures of one pulse are apart at most. Default: 100")
      .needs(trigger);
}

}  // namespace

void add_certify_command(CommandLine& line) {
  auto options = std::make_shared<CertifyOptions>();
  Command command(line, "certify",
                  "How far the frames of each set can be apart, for sure, and what limits it");
  command
      .text("input", "SCENARIO|DIR", options->input,
            "A scenario, or a folder that `simbench record` wrote")
      .required();
  command.pipelines(options->certificates.pipelines);
  command.text("--within", "TIME", options->within,
               "The bound for which shares of the sets are counted, as in 500us. Default: 1ms");
  command.number("--require", "PERCENT", options->required_percent, 0, 100,
                 "Fail unless so many of each pipeline's sets are surely within it");
  add_assumption_options(command, *options);
  command.flag(
      "--causal", options->causal,
      "Use only what came before a set's last exposure, as a program would that certifies\n"
      "while it runs");
  command.sets(options->sets);
  command.count("--seeds", options->certificates.seeds, "Captures of a scenario. Default: 1");
  command.seed("--first-seed", options->certificates.first_seed, "The first seed. Default: 1");
  command.jobs(options->certificates.jobs);
  const Option logs = command.texts(
      "--clock-log", "HOST=FILE", options->clock_logs,
      "What a program on a host exchanged meanwhile, of a recording: ntpd's rawstats, chrony's\n"
      "measurements.log (estimates) or refclocks.log (pulses); may be given several times");
  command
      .texts("--host-address", "HOST=ADDRESS", options->host_addresses,
             "A server that these logs name is this host of the rig; others are clocks outside")
      .needs(logs);
  command.output("--pairs", "FILE.csv", options->pairs,
                 "Also write the interval of every pair of frames of every set");
  command.format(options->format, {"table", "markdown", "latex", "json"});
  command.footer(kCertifyExamples);
  command.runs([options] { return run_certify(*options); });
}

}  // namespace simbench::cli
