// JSON files that may have been cut short or edited by hand, read value by value.
//
// A value knows where it stands, so that each refusal names file, line and JSON pointer, what was
// found and what is allowed. Lines are looked for only when something is wrong: the files are large
// and mostly right.
//
// Errors: scenarios::InputError.
//
//   const JsonFile file = read_json_file("results.json", "write it with ...");
//   const JsonNode root(file, file.value);
//   const std::int64_t seeds = root["seeds"]["count"].count();
#ifndef SIMBENCH_REPORTS_TEXT_JSON_NODE_H_
#define SIMBENCH_REPORTS_TEXT_JSON_NODE_H_

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

struct JsonFile {
  std::string path;
  std::string text;
  nlohmann::json value;
};

// `advice` is what to do where there is no such file.
JsonFile read_json_file(const std::string& path, const std::string& advice);

class JsonNode {
 public:
  // `file` and `value` must outlive the node.
  JsonNode(const JsonFile& file, const nlohmann::json& value, std::string pointer = {})
      : file_(file), value_(value), pointer_(std::move(pointer)) {}

  [[noreturn]] void refuse(const std::string& allowed) const;
  [[noreturn]] void fail(const std::string& problem) const;

  // A member that has to be there.
  JsonNode operator[](const char* key) const;
  bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
  std::vector<JsonNode> elements() const;
  // In alphabetical order.
  std::vector<std::string> keys() const;

  bool is_null() const { return value_.is_null(); }
  std::string text() const;
  bool flag() const;
  double number() const;  // null is NaN
  std::int64_t count() const;
  // Numbers or nulls, one for each seed.
  std::vector<double> numbers(std::size_t seeds) const;
  // The member "values" with its median and band computed anew.
  evaluation::Series series(std::size_t seeds) const;
  // The member "schema_version": 1 to `newest`.
  void check_schema_version(int newest) const;
  std::string dump() const { return value_.dump(2); }

 private:
  const JsonFile& file_;
  const nlohmann::json& value_;
  std::string pointer_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_JSON_NODE_H_
