// Reads JSON files that may be cut short or edited by hand, value by value.
//
// A value knows its place, so that each refusal names file, line and JSON pointer, what was found
// and what is allowed. Lines are determined only for an error: the files are large and mostly
// right.
//
// Errors: scenarios::InputError.
//
//   const JsonFile file = read_json_file("results.json", "write it with ...");
//   const JsonNode root(file, file.value);
//   const std::int64_t seeds = root["seeds"]["count"].count();
#pragma once

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

// `advice`: the remedy for a missing file.
JsonFile read_json_file(const std::string& path, const std::string& advice);

class JsonNode {
 public:
  // `file` and `value` must outlive the node.
  JsonNode(const JsonFile& file, const nlohmann::json& value, std::string pointer = {})
      : file_(file), value_(value), pointer_(std::move(pointer)) {}

  [[noreturn]] void refuse(const std::string& allowed) const;
  [[noreturn]] void fail(const std::string& problem) const;

  // A member, which must exist.
  JsonNode operator[](const char* key) const;
  bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
  std::vector<JsonNode> elements() const;

  bool is_null() const { return value_.is_null(); }
  std::string text() const;
  bool flag() const;
  double number() const;  // null is NaN
  std::int64_t count() const;
  // A metric's number (null is NaN), or its values, one for each seed: such as it can be.
  double value_of(const evaluation::Metric& metric) const;
  std::vector<double> values_of(const evaluation::Metric& metric, std::size_t seeds) const;
  // The member "schema_version": 1 to `newest`. The message for a later one names the member
  // "version" beside it, the simbench that wrote the file.
  void check_schema_version(int newest) const;
  std::string dump() const { return value_.dump(2); }

 private:
  const JsonFile& file_;
  const nlohmann::json& value_;
  std::string pointer_;
};

// For writing: keeps members in order; NaN becomes null.
using Json = nlohmann::ordered_json;

// The first members of a document: "schema_version", and "version" and "commit" of this program.
Json new_document(int schema_version = 1);

// {"median", "p05", "p95"}; series_json() has "values" in seed order too.
Json band_json(const evaluation::Series& series);
Json series_json(const evaluation::Series& series);

// The text of a JSON file: indented by two, ends with a line feed, other bytes than UTF-8 replaced.
std::string file_text(const Json& json);

}  // namespace simbench::reports
