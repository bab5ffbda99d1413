#include "reports/results/derivation_json.h"

#include <string>

namespace simbench::reports {
namespace {

using scenarios::Derivation;

Json stated_value(const std::string& value) { return value.empty() ? Json() : Json::parse(value); }

std::string value_text(const JsonNode& node) {
  return node.is_null() ? "" : Json::parse(node.dump()).dump();
}

}  // namespace

void state_derivation(const Derivation& derivation, Json& root) {
  if (derivation.base.empty() && derivation.unpublished.empty()) return;
  root["based_on"] = derivation.base.empty() ? Json() : Json(derivation.base);
  Json& changed = root["changed"] = Json::array();
  for (const scenarios::Change& change : derivation.changes) {
    changed.push_back({{"pointer", change.pointer},
                       {"from", stated_value(change.from)},
                       {"to", stated_value(change.to)}});
  }
  root["published_left_out"] =
      derivation.unpublished.empty() ? Json() : Json(derivation.unpublished);
}

Derivation read_derivation(const JsonNode& root) {
  Derivation derivation;
  if (!root.has("based_on")) return derivation;
  if (const JsonNode base = root["based_on"]; !base.is_null()) derivation.base = base.text();
  for (const JsonNode& change : root["changed"].elements()) {
    derivation.changes.push_back(
        {change["pointer"].text(), value_text(change["from"]), value_text(change["to"])});
  }
  const JsonNode unpublished = root["published_left_out"];
  if (!unpublished.is_null()) derivation.unpublished = unpublished.text();
  return derivation;
}

}  // namespace simbench::reports
