#include "sim/programs/program_file.h"

#include <elf.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "sim/programs/find_program.h"

namespace simbench::sim {
namespace {

#if defined(__x86_64__)
constexpr Elf64_Half kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kMachine = EM_AARCH64;
#endif

// What follows is read from a file that anybody may have written.
constexpr std::size_t kMostNames = std::size_t{1} << 20;
constexpr std::size_t kMostInterpreter = 4096;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw ProgramError(path + ": " + why);
}

class ProgramFile {
 public:
  explicit ProgramFile(const std::string& path) : path_(path), in_(path, std::ios::binary) {
    if (!in_) refuse(path, std::strerror(errno));
  }

  // Returns as much as there is.
  std::string text(std::uint64_t offset, std::size_t size) {
    std::string result(size, '\0');
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(offset & INT64_MAX));
    in_.read(result.data(), static_cast<std::streamsize>(size));
    result.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in_.gcount())));
    return result;
  }
  template <class T>
  std::optional<T> structure(std::uint64_t offset) {
    const std::string bytes = text(offset, sizeof(T));
    if (bytes.size() < sizeof(T)) return std::nullopt;
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

 private:
  std::string path_;
  std::ifstream in_;
};

bool is_go(ProgramFile& file, const Elf64_Ehdr& head) {
  const auto section = [&](std::size_t index) {
    return file.structure<Elf64_Shdr>(head.e_shoff + index * sizeof(Elf64_Shdr));
  };
  if (head.e_shoff == 0 || head.e_shentsize != sizeof(Elf64_Shdr)) return false;
  const auto names = section(head.e_shstrndx);
  if (!names) return false;
  const std::string text =
      file.text(names->sh_offset, std::min<std::uint64_t>(names->sh_size, kMostNames));
  for (std::size_t i = 0; i < head.e_shnum; ++i) {
    const auto each = section(i);
    if (!each || each->sh_name >= text.size()) continue;
    const std::string_view name = text.data() + each->sh_name;
    if (name == ".go.buildinfo" || name == ".note.go.buildid") return true;
  }
  return false;
}

// The dynamic loader that it asks for; empty: none.
std::string loader_of(ProgramFile& file, const Elf64_Ehdr& head) {
  if (head.e_phentsize != sizeof(Elf64_Phdr)) return "";
  for (std::size_t i = 0; i < head.e_phnum; ++i) {
    const auto part = file.structure<Elf64_Phdr>(head.e_phoff + i * sizeof(Elf64_Phdr));
    if (!part || part->p_type != PT_INTERP) continue;
    const std::string text =
        file.text(part->p_offset, std::min<std::uint64_t>(part->p_filesz, kMostInterpreter));
    return text.substr(0, text.find('\0'));
  }
  return "";
}

void check_elf(const std::string& path, ProgramFile& file) {
  const auto head = file.structure<Elf64_Ehdr>(0);
  if (!head || head->e_ident[EI_CLASS] != ELFCLASS64 || head->e_ident[EI_DATA] != ELFDATA2LSB ||
      head->e_machine != kMachine) {
    refuse(path, "is for another architecture than this machine's");
  }
  if (head->e_type != ET_EXEC && head->e_type != ET_DYN) refuse(path, "is no program");
  if (is_go(file, *head)) {
    refuse(path, "is written in Go, which calls the kernel without the preloaded library");
  }
  const std::string loader = loader_of(file, *head);
  if (loader.empty()) refuse(path, "is static: the preloaded library cannot reach it");
  if (!std::filesystem::path(loader).filename().string().starts_with("ld-linux")) {
    refuse(path, fmt::format("is linked with another C library than glibc ({})", loader));
  }
}

void check_rights(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) refuse(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder");
  if (!S_ISREG(status.st_mode)) refuse(path, "is no file");
  if (access(path.c_str(), X_OK) != 0) refuse(path, "is not executable");
  const bool has_capabilities = getxattr(path.c_str(), "security.capability", nullptr, 0) > 0;
  if ((status.st_mode & (S_ISUID | S_ISGID)) != 0 || has_capabilities) {
    refuse(path,
           "has rights of its own (set-uid, set-gid or file capabilities), for which preloaded "
           "libraries are ignored: make a copy without them");
  }
}

// The words of a script's first line after "#!": the interpreter, and the rest as one word.
std::vector<std::string> first_line(ProgramFile& file) {
  const std::string line = file.text(2, kMostInterpreter);
  std::istringstream text(line.substr(0, line.find('\n')));
  std::vector<std::string> words(1);
  text >> words[0];
  std::string rest;
  std::getline(text >> std::ws, rest);
  rest.erase(std::min(rest.size(), rest.find_last_not_of(" \t\r") + 1));
  if (words[0].empty()) throw ProgramError("none is named after #!");
  if (!rest.empty()) words.push_back(rest);
  return words;
}

// env would start it: `#!/usr/bin/env -S name arguments`.
std::vector<std::string> without_env(const std::vector<std::string>& words) {
  if (std::filesystem::path(words[0]).filename() != "env") return words;
  std::vector<std::string> result;
  std::istringstream rest(words.size() > 1 ? words[1] : "");
  for (std::string word; rest >> word;) {
    if (word != "-S") result.push_back(word);
  }
  if (result.empty()) throw ProgramError("env without a name");
  return result;
}

bool is_elf(ProgramFile& file) { return file.text(0, SELFMAG) == ELFMAG; }

std::vector<std::string> interpreter_of(const std::string& path, ProgramFile& script) {
  try {
    std::vector<std::string> words = without_env(first_line(script));
    words[0] = program_path(words[0]);
    check_rights(words[0]);
    ProgramFile file(words[0]);
    if (!is_elf(file)) refuse(words[0], "is a script too");
    check_elf(words[0], file);
    return words;
  } catch (const ProgramError& error) {
    refuse(path, fmt::format("its interpreter: {}", error.what()));
  }
}

}  // namespace

std::vector<std::string> program_command(const std::string& path) {
  check_rights(path);
  ProgramFile file(path);
  if (is_elf(file)) {
    check_elf(path, file);
    return {path};
  }
  if (file.text(0, 2) != "#!")
    refuse(path, "is neither a program nor a script that begins with #!");
  std::vector<std::string> words = interpreter_of(path, file);
  words.push_back(path);
  return words;
}

}  // namespace simbench::sim
