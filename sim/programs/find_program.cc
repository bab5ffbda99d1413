#include "sim/programs/find_program.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <system_error>

#include "sim/programs/program_file.h"

namespace simbench::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::array kFolders = {"usr/local/sbin", "usr/local/bin", "usr/sbin",   "usr/bin",
                                 "sbin",           "bin",           "lib/systemd"};

#if defined(__x86_64__)
constexpr char kMultiarch[] = "x86_64-linux-gnu";
#elif defined(__aarch64__)
constexpr char kMultiarch[] = "aarch64-linux-gnu";
#endif

const std::map<std::string, const char*>& packages_of_programs() {
  static const std::map<std::string, const char*> packages = {
      {"chronyd", "chrony"},
      {"ntpd", "ntpsec"},
      {"ntpdig", "ntpsec-ntpdig"},
      {"openntpd", "openntpd"},
      {"phc2sys", "linuxptp"},
      {"ptp4l", "linuxptp"},
      {"ptpd", "ptpd"},
      {"python3", "python3"},
      {"rdate", "rdate"},
      {"systemd-timesyncd", "systemd-timesyncd"},
      {"timemaster", "linuxptp"},
      {"ts2phc", "linuxptp"}};
  return packages;
}

std::vector<fs::path> own_folders() {
  std::vector<fs::path> folders;
  const char* variable = std::getenv(kProgramsVariable);
  std::istringstream text(variable != nullptr ? variable : "");
  for (std::string folder; std::getline(text, folder, ':');) {
    if (folder.empty()) continue;
    if (folder.front() != '/') {
      throw ProgramError(fmt::format("{} has \"{}\", a relative path; write an absolute one",
                                     kProgramsVariable, folder));
    }
    folders.emplace_back(folder);
  }
  return folders;
}

std::string library_path(const std::string& root) {
  std::string result;
  const auto add = [&result](const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) return;
    if (!result.empty()) result += ":";
    result += path.string();
  };
  for (const char* folder : {"usr/lib", "lib"}) {
    const fs::path path = fs::path(root) / folder / kMultiarch;
    add(path);
    add(path / "systemd");
  }
  return result;
}

[[noreturn]] void say_missing(const std::string& name) {
  const auto known = packages_of_programs().find(name);
  if (known == packages_of_programs().end()) {
    throw ProgramError(
        fmt::format("{} is not there; write its absolute path, or put its folder into {}", name,
                    kProgramsVariable));
  }
  throw ProgramError(
      fmt::format("{} is not there; it is in the Debian package {} (apt install {}; in a clone of "
                  "simbench, tools/setup --with-programs unpacks it for simbench alone)",
                  name, known->second, known->second));
}

}  // namespace

std::string program_path(const std::string& word, const std::string& packages) {
  if (word.empty()) throw ProgramError("a command without a program");
  if (word.front() == '/') return word;
  if (word.find('/') != std::string::npos) {
    throw ProgramError(
        fmt::format("found \"{}\", a relative path; write an absolute one or a bare name", word));
  }
  std::vector<fs::path> folders = own_folders();
  const auto add = [&folders](const std::string& root) {
    for (const char* folder : kFolders) folders.push_back(fs::path(root) / folder);
  };
  if (!packages.empty()) {
    add(packages);
    add(packages + "/apart/" + word);
  }
  add("/");
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / word, ignored)) return (folder / word).string();
  }
  say_missing(word);
}

FoundProgram find_program(const std::string& word, const std::string& packages) {
  const std::string path = program_path(word, packages);
  const bool is_unpacked =
      !packages.empty() && path.starts_with((fs::path(packages) / "").string());
  return {.words = program_command(path),
          .library_path = is_unpacked ? library_path(packages) : ""};
}

}  // namespace simbench::sim
