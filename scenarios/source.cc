#include "scenarios/source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "scenarios/builtin_files.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

namespace fs = std::filesystem;

// Far above any scenario, and small enough to be read before it is refused.
constexpr std::size_t kMaximumBytes = std::size_t{4} << 20;

std::optional<Source> find_builtin(const std::string& name) {
  for (const BuiltinFile& file : builtin_files()) {
    if (file.name == name) {
      return Source{name + ".json", std::string(file.text), true};
    }
  }
  return std::nullopt;
}

std::string unknown_name(const std::string& name) {
  std::vector<std::string> known;
  for (const BuiltinFile& file : builtin_files()) known.emplace_back(file.name);
  const std::vector<std::string> similar = nearest(name, known);
  return fmt::format("found \"{}\", {} {} (or the path of a .json file)", shown_text(name),
                     similar.empty() ? "allowed" : "did you mean",
                     fmt::join(similar.empty() ? known : similar, similar.empty() ? ", " : " or "));
}

bool looks_like_path(const std::string& name) {
  return name.find('/') != std::string::npos || name.ends_with(".json");
}

[[noreturn]] void fail_to_read(const std::string& prefix, const std::string& reason) {
  throw InputError(prefix + ": cannot be read: " + reason);
}

// `prefix` begins the message if the file cannot be read.
Source read_file(const std::string& path, const std::string& prefix) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail_to_read(prefix, "it is a folder");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_to_read(prefix, std::strerror(errno == 0 ? EIO : errno));
  std::string text(kMaximumBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) fail_to_read(prefix, std::strerror(errno == 0 ? EIO : errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaximumBytes) {
    fail_to_read(prefix,
                 fmt::format("found more than {} bytes, which no scenario needs", kMaximumBytes));
  }
  return {path, std::move(text), false};
}

}  // namespace

Source find_source(const std::string& name_or_path) {
  if (const auto builtin = find_builtin(name_or_path)) return *builtin;
  std::error_code ignored;
  if (looks_like_path(name_or_path) || fs::exists(name_or_path, ignored)) {
    return read_file(name_or_path, shown_text(name_or_path));
  }
  throw InputError("scenario: " + unknown_name(name_or_path));
}

Source find_base(const Source& from, const std::string& base, const std::string& place) {
  if (const auto builtin = find_builtin(base)) return *builtin;
  if (from.is_builtin || !looks_like_path(base)) {
    throw InputError(place + ": " + unknown_name(base));
  }
  const std::string path = (fs::path(from.label).parent_path() / base).lexically_normal().string();
  const std::string prefix = fmt::format("{}: found \"{}\"", place, shown_text(base));
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    fail_to_read(prefix, "it is no regular file");
  }
  return read_file(path, prefix);
}

}  // namespace simbench::scenarios
