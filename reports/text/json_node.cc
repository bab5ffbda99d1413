#include "reports/text/json_node.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "evaluation/statistics/statistics.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/text/output_file.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using nlohmann::json;
using scenarios::InputError;

constexpr std::uint64_t kLargestCount = std::numeric_limits<std::int64_t>::max();

// "FILE:LINE", or "FILE" if the line is unknown.
std::string place_of(const JsonFile& file, const std::string& pointer) {
  try {
    const auto lines = scenarios::parse_document(file.text).lines;
    if (const auto line = lines.find(pointer); line != lines.end()) {
      return fmt::format("{}:{}", file.path, line->second);
    }
  } catch (const scenarios::DocumentError& error) {
    return fmt::format("{}:{}", file.path, error.line());
  }
  return file.path;
}

// Throws the error of a text that is not JSON.
[[noreturn]] void fail_syntax(const std::string& path, const std::string& text) {
  try {
    scenarios::parse_document(text);
  } catch (const scenarios::DocumentError& error) {
    throw InputError(fmt::format("{}:{}:{}: {}; was the file cut short or edited?", path,
                                 error.line(), error.column(), error.what()));
  }
  throw InputError(fmt::format("{}: is not JSON", path));
}

}  // namespace

JsonFile read_json_file(const std::string& path, const std::string& advice) {
  std::optional<std::string> text = content_of(path);
  if (!text) throw InputError(fmt::format("{}: {}; {}", path, std::strerror(errno), advice));
  JsonFile file{path, std::move(*text), {}};
  try {
    file.value = json::parse(file.text);
  } catch (const json::exception&) {  // not JSON, or a number beyond a double
    fail_syntax(path, file.text);
  }
  return file;
}

void JsonNode::refuse(const std::string& allowed) const {
  fail(fmt::format("found {}, allowed: {}", scenarios::shown(value_), allowed));
}

void JsonNode::fail(const std::string& problem) const {
  throw InputError(fmt::format("{}: {}: {}", place_of(file_, pointer_),
                               pointer_.empty() ? "the whole file" : pointer_, problem));
}

JsonNode JsonNode::operator[](const char* key) const {
  if (!value_.is_object()) refuse("an object");
  const auto member = value_.find(key);
  if (member == value_.end()) fail(fmt::format("'{}' is missing; was the file edited?", key));
  return {file_, *member, scenarios::child_pointer(pointer_, key)};
}

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_.is_array()) refuse("an array");
  std::vector<JsonNode> all;
  for (std::size_t i = 0; i < value_.size(); ++i) {
    all.emplace_back(file_, value_[i], fmt::format("{}/{}", pointer_, i));
  }
  return all;
}

std::string JsonNode::text() const {
  if (!value_.is_string()) refuse("text");
  return value_.get<std::string>();
}

bool JsonNode::flag() const {
  if (!value_.is_boolean()) refuse("true or false");
  return value_.get<bool>();
}

double JsonNode::number() const {
  if (value_.is_null()) return evaluation::kNan;
  if (!value_.is_number()) refuse("a number or null");
  return value_.get<double>();
}

std::int64_t JsonNode::count() const {
  if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() > kLargestCount) {
    refuse("a whole number from 0");
  }
  return value_.get<std::int64_t>();
}

double JsonNode::value_of(const evaluation::Metric& metric) const {
  const double value = number();
  if (!metric.can_be(value)) refuse(metric.allowed());
  return value;
}

std::vector<double> JsonNode::values_of(const evaluation::Metric& metric, std::size_t seeds) const {
  if (!value_.is_array()) refuse(fmt::format("an array of {} values, one for each seed", seeds));
  if (value_.size() != seeds) {
    fail(fmt::format("found {} values, allowed: {}, one for each seed", value_.size(), seeds));
  }
  std::vector<double> all;
  all.reserve(seeds);
  for (const JsonNode& element : elements()) all.push_back(element.value_of(metric));
  return all;
}

void JsonNode::check_schema_version(int newest) const {
  const JsonNode version = (*this)["schema_version"];
  const std::int64_t found = version.count();
  if (found > newest) {
    const bool is_stated = has("version") && value_["version"].is_string();
    version.refuse(
        fmt::format("at most {}; {}", newest,
                    advice_on_newer_format(is_stated ? value_["version"].get<std::string>() : "")));
  }
  if (found < 1) version.refuse(fmt::format("1 to {}", newest));
}

Json new_document(int schema_version) {
  return {{"schema_version", schema_version}, {"version", version()}, {"commit", commit()}};
}

Json band_json(const evaluation::Series& series) {
  return {{"median", series.median}, {"p05", series.p05}, {"p95", series.p95}};
}

Json series_json(const evaluation::Series& series) {
  Json json = band_json(series);
  json["values"] = series.values;
  return json;
}

std::string file_text(const Json& json) {
  return printable_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace simbench::reports
