#include <fmt/format.h>

#include <cmath>

#include "reports/advice/advice_report.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

std::string bounds_text(const RareResult& result, double times) {
  const evaluation::RareEstimate& estimate = result.estimate;
  if (estimate.is_below) return "-";
  return fmt::format("[{}, {}]", number_text(times * estimate.low),
                     number_text(times * estimate.high));
}

std::string value_or_below(const RareResult& result, double times) {
  const evaluation::RareEstimate& estimate = result.estimate;
  if (!estimate.is_below) return number_text(times * estimate.probability);
  return std::isfinite(estimate.high) && estimate.high > 0
             ? fmt::format("below about {}", number_text(times * estimate.high))
             : "too rare";
}

}  // namespace

Block rare_block(const std::string& heading, const std::vector<RareResult>& results) {
  const std::vector<Field<RareResult>> fields = {
      {{"event", Align::kLeft}, [](const RareResult& each) { return each.event; }},
      {{"probability\nper set"}, [](const RareResult& each) { return value_or_below(each, 1); }},
      {{"95 %\ninterval"}, [](const RareResult& each) { return bounds_text(each, 1); }},
      {{"sets\nper day"},
       [](const RareResult& each) { return value_or_below(each, each.sets_per_day); }},
      {{"95 %\ninterval"},
       [](const RareResult& each) { return bounds_text(each, each.sets_per_day); }},
      {{"simulated\nruns"},
       [](const RareResult& each) {
         return count_text(static_cast<std::int64_t>(each.estimate.runs));
       }},
      {{"repeats"}, [](const RareResult& each) {
         return count_text(static_cast<std::int64_t>(each.estimate.repeats.size()));
       }}};
  return {.heading = heading,
          .table = table_of(fields, results),
          .prose = {"By importance splitting over clocks, calibrations and loads of the runs; the "
                    "interval is that of independent repeats, as many as the budget of runs holds: "
                    "it is what these show, and a way to the event that none of them found is not "
                    "in it. The probability is that of any set of any such rig: one rig is better "
                    "or worse. Below about: the runs did not get to the event, and the number, the "
                    "probability of what they got to, is a guide without an interval. What is not "
                    "in the world (a "
                    "cable that fails, a service that restarts) is not counted."}};
}

Json rare_json(const std::vector<RareResult>& results) {
  Json all = Json::array();
  for (const RareResult& each : results) {
    const evaluation::RareEstimate& estimate = each.estimate;
    all.push_back({{"event", each.event},
                   {"bound_ms", each.bound_ms},
                   {"probability", estimate.probability},
                   {"low", estimate.low},
                   {"high", estimate.high},
                   {"per_day", estimate.probability * each.sets_per_day},
                   {"per_day_low", estimate.low * each.sets_per_day},
                   {"per_day_high", estimate.high * each.sets_per_day},
                   {"is_below", estimate.is_below},
                   {"runs", estimate.runs},
                   {"repeats", estimate.repeats.size()}});
  }
  return all;
}

}  // namespace simbench::reports
