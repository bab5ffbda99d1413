#include "hardware/rig/rig_document.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "hardware/rig/rig_schema.h"
#include "scenarios/document.h"
#include "scenarios/json_schema.h"
#include "scenarios/schema.h"

namespace simbench::hardware {
namespace {

namespace fs = std::filesystem;
using scenarios::InputError;
using scenarios::shown_text;

// Far above a rig of a thousand hosts, and small enough to be read before it is refused.
constexpr std::size_t kMaximumBytes = std::size_t{4} << 20;

[[noreturn]] void fail_to_read(const std::string& path, const std::string& reason) {
  throw InputError(fmt::format("{}: cannot be read: {}", shown_text(path), reason));
}

}  // namespace

std::string read_rig_text(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail_to_read(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail_to_read(path, "it is no regular file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_to_read(path, std::strerror(errno == 0 ? EIO : errno));
  std::string text(kMaximumBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) fail_to_read(path, std::strerror(errno == 0 ? EIO : errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaximumBytes) {
    fail_to_read(path, fmt::format("found more than {} bytes, which no rig needs", kMaximumBytes));
  }
  return text;
}

RigDocument parse_rig_document(const std::string& text, const std::string& path) {
  static const scenarios::JsonSchema schema(nlohmann::json::parse(rig_schema_text()));
  const std::string label = shown_text(path);
  RigDocument document;
  try {
    scenarios::Document parsed = scenarios::parse_document(text);
    document.root = std::move(parsed.root);
    for (const auto& [pointer, line] : parsed.lines) {
      document.places.set(pointer, {.label = fmt::format("{}:{}", label, line),
                                    .set_pointer = "",
                                    .is_set = false,
                                    .is_builtin = false,
                                    .level = 0,
                                    .line = line});
    }
  } catch (const scenarios::DocumentError& error) {
    throw InputError(
        fmt::format("{}:{}:{}: {}", label, error.line(), error.column(), error.what()));
  }
  scenarios::validate(document.root, schema, document.places);
  return document;
}

}  // namespace simbench::hardware
