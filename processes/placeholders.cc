#include "processes/placeholders.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <boost/algorithm/string/replace.hpp>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <utility>

#include "processes/lesser_user.h"
#include "recording/distrusted_folder.h"

namespace simbench::processes {
namespace {

constexpr char kNtpDrift[] = "{ntp_drift}";
constexpr char kChronyDrift[] = "{chrony_drift}";

std::string dotted(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 255, address >> 8 & 255,
                     address & 255);
}

// Whether it needs a drift file that the host does not have.
bool lacks_drift(const std::string& text, const HostPlaces& places) {
  if (places.drift) return false;
  return text.find(kNtpDrift) != std::string::npos || text.find(kChronyDrift) != std::string::npos;
}

// The rights of a file that root makes, whatever the caller's umask is.
void make_usual(const std::filesystem::path& path) {
  const bool is_folder = std::filesystem::is_directory(path);
  std::filesystem::permissions(path, static_cast<std::filesystem::perms>(is_folder ? 0755 : 0644));
}

}  // namespace

std::string fill(std::string text, const HostPlaces& places) {
  const double correction_ppm = places.drift ? places.drift->ppb * 1e-3 : 0;
  const double error_ppm = places.drift ? places.drift->error_ppb * 1e-3 : 0;
  const std::pair<const char*, std::string> values[] = {
      {"{master}", dotted(address_of(places.follows))},
      {"{address}", dotted(address_of(places.host))},
      {"{host}", std::to_string(places.host)},
      {"{interface}", places.interface},
      {"{files}", places.files},
      {kNtpDrift, fmt::format("{:.6f}", correction_ppm)},
      {kChronyDrift, fmt::format("{:.6f} {:.6f}", -correction_ppm, error_ppm)}};
  for (const auto& [place, value] : values) boost::replace_all(text, place, value);
  return text;
}

std::vector<std::string> fill(std::vector<std::string> command, const HostPlaces& places) {
  for (std::string& word : command) word = fill(std::move(word), places);
  return command;
}

std::map<std::string, std::string> fill(std::map<std::string, std::string> environment,
                                        const HostPlaces& places) {
  for (auto& [name, value] : environment) value = fill(std::move(value), places);
  return environment;
}

std::string make_folder(const std::filesystem::path& folder,
                        const scenarios::HostPrograms& programs, const HostPlaces& places) {
  remove_tree(folder);
  std::filesystem::create_directories(folder);
  for (const auto& [name, content] : programs.files) {
    if (lacks_drift(content, places)) continue;
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << fill(content, places);
  }
  make_usual(folder);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    make_usual(entry.path());
    const timespec begin{.tv_sec = shim::kWorldBegin / 1'000'000'000, .tv_nsec = 0};
    const timespec both[] = {begin, begin};
    utimensat(AT_FDCWD, entry.path().c_str(), both, 0);
  }
  return folder.string();
}

std::optional<std::string> unknown_placeholder(const std::string& text) {
  constexpr std::string_view kWord = "abcdefghijklmnopqrstuvwxyz_";
  const std::string filled = fill(text, {});
  for (std::size_t at = filled.find('{'); at != std::string::npos; at = filled.find('{', at + 1)) {
    const std::size_t end = filled.find_first_not_of(kWord, at + 1);
    if (end != std::string::npos && end > at + 1 && filled[end] == '}') {
      return filled.substr(at, end + 1 - at);
    }
  }
  return std::nullopt;
}

std::optional<std::string> unknown_placeholder(const scenarios::HostPrograms& programs) {
  std::optional<std::string> found;
  const auto look = [&found](const std::string& text) {
    if (!found) found = unknown_placeholder(text);
  };
  for (const auto* role : {&programs.master, &programs.slave}) {
    for (const auto& command : *role) {
      for (const std::string& word : command) look(word);
    }
  }
  for (const auto& [name, content] : programs.files) look(content);
  for (const std::string& path : programs.readable) look(path);
  for (const auto& [name, value] : programs.environment) look(value);
  return found;
}

}  // namespace simbench::processes
