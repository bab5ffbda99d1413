// A JSON Schema (draft-07) as a validator: the one place that includes valijson.
#ifndef SIMBENCH_SCENARIOS_JSON_SCHEMA_H_
#define SIMBENCH_SCENARIOS_JSON_SCHEMA_H_

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace simbench::scenarios {

class JsonSchema {
 public:
  // A value that was refused, and after it the values around it.
  struct Refusal {
    std::vector<std::string> keys;  // the way to it: keys and array indices
    std::string reason;
  };

  // The schema must be one that valijson accepts; anything else is a programming error.
  explicit JsonSchema(nlohmann::json text);
  ~JsonSchema();
  JsonSchema(const JsonSchema&) = delete;
  JsonSchema& operator=(const JsonSchema&) = delete;

  const nlohmann::json& text() const { return text_; }

  // All that is refused; empty if the document is valid. Types are strict: 1 is not "1". Safe to be
  // called by several threads.
  std::vector<Refusal> validate(const nlohmann::json& document) const;

 private:
  struct Compiled;
  nlohmann::json text_;
  std::unique_ptr<const Compiled> compiled_;
};

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_JSON_SCHEMA_H_
