#include "cli/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace simbench::cli {
namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::optional<std::size_t> width_of_output() {
  const std::string_view columns = variable("COLUMNS");
  std::size_t width = 0;
  const char* end = columns.data() + columns.size();
  const auto [stop, error] = std::from_chars(columns.data(), end, width);
  if (error == std::errc() && stop == end && width >= kNarrowest) return width;
  winsize size = {};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return std::nullopt;
  return std::max<std::size_t>(size.ws_col, kNarrowest);
}

bool takes_escapes() {
  const std::string_view term = variable("TERM");
  return !term.empty() && term != "dumb";
}

bool wants_colour() { return variable("NO_COLOR").empty() && variable("CLICOLOR") != "0"; }

}  // namespace simbench::cli
