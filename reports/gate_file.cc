#include "reports/gate_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "reports/output_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& option, const std::string& path,
                       const std::string& problem) {
  throw OutputError(fmt::format("{} {}: {}", option, path, problem));
}

}  // namespace

void write_whole_file(const std::string& option, const std::string& path, const std::string& text) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) fail(option, path, "is no file");
  const std::string temporary = fmt::format("{}.{}.part", path, getpid());
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  if (!out) fail(option, path, std::strerror(errno));
  out << text;
  out.close();
  if (!out) {
    const std::string problem = errno ? std::strerror(errno) : "write error";
    fs::remove(temporary, error);
    fail(option, path, fmt::format("{}; nothing was kept", problem));
  }
  fs::rename(temporary, path, error);
  if (error) {
    const std::string problem = error.message();
    fs::remove(temporary, error);
    fail(option, path, problem);
  }
}

}  // namespace simbench::reports
