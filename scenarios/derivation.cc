#include "scenarios/derivation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenarios/changes.h"
#include "scenarios/document.h"

namespace simbench::scenarios {
namespace {

std::string changed_value(const std::string& value) {
  if (value.empty()) return "none";
  return shown_text(value_text(nlohmann::ordered_json::parse(value)));
}

}  // namespace

std::string named(const std::string& scenario, const Derivation& derivation) {
  if (derivation.base.empty()) return scenario;
  if (derivation.base == scenario) return scenario + " (changed)";
  return fmt::format("{} (based on {})", scenario, derivation.base);
}

std::string changed_text(const Derivation& derivation, std::size_t most) {
  const std::size_t all = derivation.changes.size();
  if (all == 0) return "";
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(all, most); ++i) {
    const Change& change = derivation.changes[i];
    texts.push_back(fmt::format("{} {} → {}", shown_text(change.pointer),
                                changed_value(change.from), changed_value(change.to)));
  }
  std::string text = fmt::format("changed: {}", fmt::join(texts, ", "));
  if (all > most) text += fmt::format(", and {} more", all - most);
  return text;
}

std::string unpublished_text(const Derivation& derivation) {
  if (derivation.unpublished.empty()) return "";
  return fmt::format(
      "The published values of {} are left out: they hold in its world alone, and this is another.",
      derivation.unpublished);
}

std::vector<std::string> derivation_lines(const Derivation& derivation) {
  std::vector<std::string> lines = {changed_text(derivation), unpublished_text(derivation)};
  std::erase(lines, "");
  return lines;
}

}  // namespace simbench::scenarios
