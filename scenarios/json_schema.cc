#include "scenarios/json_schema.h"

#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace simbench::scenarios {

using valijson::adapters::NlohmannJsonAdapter;

struct JsonSchema::Compiled {
  explicit Compiled(const nlohmann::json& text) {
    const NlohmannJsonAdapter adapter(text);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, schema);
  }
  valijson::Schema schema;
};

JsonSchema::JsonSchema(nlohmann::json text)
    : text_(std::move(text)), compiled_(std::make_unique<const Compiled>(text_)) {}

JsonSchema::~JsonSchema() = default;

std::vector<JsonSchema::Refusal> JsonSchema::validate(const nlohmann::json& document) const {
  valijson::Validator validator;
  valijson::ValidationResults results;
  const NlohmannJsonAdapter target(document);
  std::vector<Refusal> refusals;
  if (validator.validate(compiled_->schema, target, &results)) return refusals;
  for (const auto& error : results) {
    // The place is written as {"<root>", "[key]", "[0]"}.
    Refusal refusal{{}, error.description};
    for (std::size_t i = 1; i < error.context.size(); ++i) {
      refusal.keys.push_back(error.context[i].substr(1, error.context[i].size() - 2));
    }
    refusals.push_back(std::move(refusal));
  }
  return refusals;
}

}  // namespace simbench::scenarios
