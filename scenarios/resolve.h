// From a source to the resolved scenario as JSON: inheritance, overrides, schema.
#ifndef SIMBENCH_SCENARIOS_RESOLVE_H_
#define SIMBENCH_SCENARIOS_RESOLVE_H_

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "scenarios/loader.h"
#include "scenarios/places.h"
#include "scenarios/source.h"

namespace simbench::scenarios {

struct Resolved {
  nlohmann::json document;  // complete and valid by the schema; without "base" and "$schema"
  std::shared_ptr<Places> places = std::make_shared<Places>();
};

// Every file is validated by itself, then merged over its base (RFC 7386: objects are merged,
// anything else is replaced, null removes); then the overrides are applied in their order; then the
// whole is validated. Published results inherited for pipelines that are no longer there are
// dropped. Throws InputError.
Resolved resolve(Source source, const std::vector<Override>& overrides);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_RESOLVE_H_
