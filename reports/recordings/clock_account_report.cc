#include "reports/recordings/clock_account_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "evaluation/statistics/statistics.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::ClockAccount;
using evaluation::ClockExplanation;
using evaluation::ClockFinding;
using evaluation::LoggedChange;
using evaluation::LoggedClock;
using evaluation::LogPlacing;
using evaluation::SpreadBudget;
using evaluation::SpreadPart;

struct NamedPart {
  const char* name;
  const char* text;
  SpreadPart SpreadBudget::*part;
};

constexpr std::array<NamedPart, 6> kParts = {{
    {"exposure", "exposure lengths", &SpreadBudget::exposure},
    {"stamp", "stamps (jitter of the exposures)", &SpreadBudget::stamp},
    {"delivery", "delivery (jitter of the delays)", &SpreadBudget::delivery},
    {"host_clock", "clocks of the hosts", &SpreadBudget::host_clock},
    {"constant", "constant (phases, mean delays)", &SpreadBudget::constant},
    {"unexplained", "unexplained (slow)", &SpreadBudget::unexplained},
}};

// Without the sign of what rounds to 0.
std::string signed_percent(double share, int decimals) {
  const double scale = std::pow(10, decimals);
  return fmt::format("{:.{}f} %", std::round(100 * share * scale) / scale + 0.0, decimals);
}

std::string known_ms(const SpreadPart& part) {
  return std::isnan(part.rms_ms) ? "unknown" : number_text(part.rms_ms);
}

std::string log_placed_text(const LoggedClock& clock) {
  switch (clock.placing) {
    case LogPlacing::kAsIs:
      return "as it is";
    case LogPlacing::kByZone:
      return fmt::format("{:+.4g} h", clock.shift_s / 3600);
    case LogPlacing::kBySteps:
      return "by its steps";
    case LogPlacing::kNowhere:
      break;
  }
  return "nowhere";
}

Json placed_json(LogPlacing placing) {
  switch (placing) {
    case LogPlacing::kAsIs:
      return "as_is";
    case LogPlacing::kByZone:
      return "zone";
    case LogPlacing::kBySteps:
      return "steps";
    case LogPlacing::kNowhere:
      break;
  }
  return nullptr;
}

// During the recording, or over all of a log that is not placed.
double log_within_ms(const LoggedClock& clock, const ClockAccount& account) {
  double first_s = evaluation::kNan;
  double last_s = evaluation::kNan;
  for (const evaluation::ClockedCamera& camera : account.cameras) {
    if (camera.host != clock.host) continue;
    first_s = std::fmin(first_s, camera.arrivals.first_s);
    last_s = std::fmax(last_s, camera.arrivals.last_s);
  }
  return 1e3 * clock.within_s(first_s, last_s);
}

Block logs_block(const ClockAccount& account) {
  Table table({{"host", Align::kLeft},
               {"log", Align::kLeft},
               {"format", Align::kLeft},
               {.header = "placed",
                .align = Align::kLeft,
                .legend = "how its times were put on the scale of the arrivals"},
               {"points"},
               {"interval\ns"},
               {.header = "within\nms", .legend = "the largest error during the recording"},
               {"steps"},
               {"slews"}},
              2);
  for (const LoggedClock& clock : account.logs) {
    const auto slews = std::ranges::count_if(clock.changes, &LoggedChange::is_slew);
    const auto steps = std::ranges::count_if(
        clock.changes, [](const LoggedChange& one) { return one.lasts && !one.is_slew; });
    table.add({clock.has_host ? clock.host : "none", clock.file, clock.format,
               log_placed_text(clock), count_text(static_cast<std::int64_t>(clock.time_s.size())),
               number_text(clock.interval_s), number_text(log_within_ms(clock, account)),
               count_text(steps), count_text(slews)});
  }
  return {.heading = "The clocks of the hosts by their logs", .table = std::move(table)};
}

std::optional<Block> explanations_block(const ClockAccount& account) {
  if (account.explanations.empty()) return std::nullopt;
  Table table({{"camera", Align::kLeft},
               {"stream", Align::kLeft},
               {"host", Align::kLeft},
               {.header = "delays\nmove ms", .legend = "deviation of their medians about a line"},
               {.header = "without\nthe clock", .legend = "the log's error subtracted"},
               {.header = "explained", .legend = "share of the variance; below 0: worse"},
               {.header = "factor that fits best [95 %]", .legend = "1: a clock's"}},
              2);
  for (const ClockExplanation& one : account.explanations) {
    const bool is_known = std::isfinite(one.coefficient);
    table.add({one.camera, one.stream, one.host, number_text(one.before_ms),
               number_text(one.after_ms),
               std::isnan(one.share) ? "-"
               : one.share < 0       ? signed_percent(one.share, 0)
                                     : share_text(one.share),
               is_known ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", one.coefficient,
                                      one.coefficient_low, one.coefficient_high)
                        : "-"});
  }
  return Block{.heading = "What the clocks explain of the delays", .table = std::move(table)};
}

std::optional<Block> spreads_block(const ClockAccount& account) {
  if (account.budgets.empty()) return std::nullopt;
  Table table({{"camera", Align::kLeft},
               {"against", Align::kLeft},
               {"stream", Align::kLeft},
               {"apart\nms"},
               {"exposure"},
               {"stamp"},
               {"delivery"},
               {"hosts'\nclocks"},
               {"constant"},
               {"unex-\nplained"}},
              2);
  for (const SpreadBudget& budget : account.budgets) {
    std::vector<std::string> cells = {budget.camera, budget.against, budget.stream,
                                      number_text(budget.total.rms_ms)};
    for (const NamedPart& part : kParts) cells.push_back(known_ms(budget.*part.part));
    table.add(std::move(cells));
  }
  return Block{.heading = "What sets the arrivals at one pulse apart",
               .table = std::move(table),
               .prose = {"Root mean squares in ms. Unknown: no exposure lengths, or no log of a "
                         "host; the other parts have it then."}};
}

std::optional<Block> widest_block(const ClockAccount& account) {
  if (account.budgets.empty()) return std::nullopt;
  const SpreadBudget& widest = *std::ranges::max_element(
      account.budgets, {}, [](const SpreadBudget& budget) { return budget.total.rms_ms; });
  Table table({{"part", Align::kLeft},
               {"RMS ms"},
               {"95 %\nms"},
               {.header = "share", .legend = "of the mean square; below 0: it takes others back"}});
  const auto add_part = [&table](const char* text, const SpreadPart& part) {
    const bool is_known = !std::isnan(part.rms_ms);
    table.add({text, known_ms(part),
               is_known
                   ? fmt::format("[{}, {}]", number_text(part.low_ms), number_text(part.high_ms))
                   : "-",
               is_known ? signed_percent(part.share, 1) : "-"});
  };
  for (const NamedPart& part : kParts) add_part(part.text, widest.*part.part);
  add_part("all", widest.total);
  return Block{
      .heading = fmt::format("The widest pair: {} against {}", widest.camera, widest.against),
      .table = std::move(table),
      .prose = {fmt::format("{} pairs of frames. Slow: over more than {} s.",
                            count_text(static_cast<std::int64_t>(widest.pairs)),
                            number_text(widest.block_s))}};
}

Json spread_part_json(const SpreadPart& part) {
  return {{"rms_ms", part.rms_ms},
          {"low_ms", part.low_ms},
          {"high_ms", part.high_ms},
          {"share", part.share}};
}

Json log_json(const LoggedClock& clock, const ClockAccount& account) {
  Json changes = Json::array();
  for (const LoggedChange& change : clock.changes) {
    changes.push_back({{"at_s", change.at_s},
                       {"until_s", change.until_s},
                       {"by_ms", 1e3 * change.by_s},
                       {"slew", change.is_slew},
                       {"lasts", change.lasts}});
  }
  Json json = {{"host", nullptr},
               {"file", clock.file},
               {"series", clock.series},
               {"format", clock.format},
               {"placed", placed_json(clock.placing)},
               {"shift_s", clock.shift_s},
               {"daylight_saving_s", nullptr},
               {"points", clock.time_s.size()},
               {"first_s", clock.first_s()},
               {"last_s", clock.last_s()},
               {"interval_s", clock.interval_s},
               {"within_ms", log_within_ms(clock, account)},
               {"summaries", clock.are_summaries},
               {"changes", std::move(changes)}};
  if (clock.has_host) json["host"] = clock.host;
  if (clock.daylight_saving) json["daylight_saving_s"] = clock.daylight_saving->by_s;
  return json;
}

Json jumps_json(const ClockAccount& account) {
  Json all = Json::array();
  for (std::size_t i = 0; i < account.jumps.size(); ++i) {
    const evaluation::HostJump& jump = account.jumps[i];
    Json json = {{"host", jump.host},      {"cameras", jump.cameras},
                 {"at_s", jump.jump.at_s}, {"step_ms", jump.jump.step_ms},
                 {"file", nullptr},        {"log_step_ms", nullptr}};
    const auto match = std::ranges::find(account.matches, i, &evaluation::MatchedStep::jump);
    if (match != account.matches.end()) {
      const LoggedClock& clock = account.logs[match->log];
      json["file"] = clock.file;
      json["log_step_ms"] = 1e3 * clock.changes[match->change].by_s;
    }
    all.push_back(std::move(json));
  }
  return all;
}

Json explanation_json(const ClockExplanation& one) {
  return {{"camera", one.camera},
          {"host", one.host},
          {"stream", one.stream},
          {"bins", one.bins},
          {"before_ms", one.before_ms},
          {"after_ms", one.after_ms},
          {"noise_ms", one.noise_ms},
          {"share", one.share},
          {"coefficient", one.coefficient},
          {"coefficient_low", one.coefficient_low},
          {"coefficient_high", one.coefficient_high}};
}

Json spread_json(const SpreadBudget& budget) {
  Json parts = {{"total", spread_part_json(budget.total)}};
  for (const NamedPart& part : kParts) parts[part.name] = spread_part_json(budget.*part.part);
  return {{"camera", budget.camera},
          {"host", budget.host},
          {"against", budget.against},
          {"host_against", budget.host_against},
          {"stream", budget.stream},
          {"pairs", budget.pairs},
          {"block_s", budget.block_s},
          {"constant_ms", budget.constant_ms},
          {"stamps_apart_ms", budget.stamps_apart_ms},
          {"parts", std::move(parts)}};
}

}  // namespace

std::vector<Block> clock_account_blocks(const ClockAccount& account) {
  if (account.logs.empty()) return {};
  std::vector<Block> blocks = {logs_block(account)};
  add(explanations_block(account), blocks);
  add(spreads_block(account), blocks);
  add(widest_block(account), blocks);
  return blocks;
}

Json clock_account_json(const ClockAccount& account) {
  Json root = {{"hosts", Json::array()},
               {"jumps", jumps_json(account)},
               {"explained", Json::array()},
               {"spread", Json::array()},
               {"findings", Json::array()}};
  for (const LoggedClock& clock : account.logs) root["hosts"].push_back(log_json(clock, account));
  for (const ClockExplanation& one : account.explanations) {
    root["explained"].push_back(explanation_json(one));
  }
  for (const SpreadBudget& budget : account.budgets) root["spread"].push_back(spread_json(budget));
  for (const ClockFinding& finding : account.findings) {
    root["findings"].push_back({{"kind", finding.kind},
                                {"host", finding.host},
                                {"harm", finding.harm},
                                {"text", finding.text}});
  }
  return root;
}

}  // namespace simbench::reports
