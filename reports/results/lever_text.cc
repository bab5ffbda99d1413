#include "reports/results/lever_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "recording/counted.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Lever;
using evaluation::Levers;
using evaluation::RankedBy;

constexpr std::size_t kNamed = 3;

// "With device_time hull_300: AMD from 2.92 to 1.89 ms".
std::string lever_sentence(const Lever& lever, RankedBy ranked_by) {
  const std::string effect =
      lever.finds_pulses()
          ? fmt::format("pulses due and not found whole from {} to {}",
                        share_text(lever.missing_from), share_text(lever.missing_to))
          : fmt::format("{} {}", evaluation::ranked_metric(ranked_by).title,
                        time_change_text(lever.from, lever.to));
  return fmt::format("With {}: {}", lever.what, effect);
}

std::string options_text(const Lever& lever) {
  std::string text = "--pipelines " + lever.pipeline;
  for (const scenarios::Override& set : lever.sets) {
    text += fmt::format(" --set {}={}", set.pointer, set.value);
  }
  return text;
}

Json lever_json(const Lever& lever, RankedBy ranked_by) {
  Json sets = Json::object();
  for (const scenarios::Override& set : lever.sets) sets[set.pointer] = set.value;
  const evaluation::Estimate& difference = lever.effect.difference;
  return {
      {"what", lever.what},
      {"pipeline", lever.pipeline},
      {"sets", std::move(sets)},
      {"metric", evaluation::ranked_metric(ranked_by).id},
      {"from", lever.from},
      {"to", lever.to},
      {"difference", difference.value},
      {"interval",
       std::isnan(difference.low) ? Json() : Json(Json::array({difference.low, difference.high}))},
      {"missing_from", lever.missing_from},
      {"missing_to", lever.missing_to},
      {"options", options_text(lever)}};
}

}  // namespace

std::string levers_text(const Levers& levers, RankedBy ranked_by, std::uint64_t seeds_of_run) {
  const std::string of_seeds =
      levers.seeds < seeds_of_run ? fmt::format(" (over {})", counted(levers.seeds, "seed")) : "";
  if (!levers.problem.empty()) return fmt::format("It is not known: {}.", levers.problem);
  if (levers.effective.empty()) {
    return fmt::format("Nothing that was tried improves it by {:g} %{}: {} and {} of the rig.",
                       100 * evaluation::kSmallestGain, of_seeds,
                       counted(levers.algorithms, "other algorithm"),
                       counted(levers.changes, "change"));
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, levers.effective.size()); ++i) {
    text += fmt::format("{}{}{}.", text.empty() ? "" : " ",
                        lever_sentence(levers.effective[i], ranked_by), of_seeds);
  }
  const std::size_t more = levers.effective.size() - std::min(kNamed, levers.effective.size());
  if (more > 0) text += fmt::format(" {} more: --format json.", more);
  return text;
}

Json levers_json(const Levers& levers, RankedBy ranked_by) {
  Json all = Json::array();
  for (const Lever& lever : levers.effective) all.push_back(lever_json(lever, ranked_by));
  return all;
}

}  // namespace simbench::reports
