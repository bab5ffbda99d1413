#include "reports/text/file_content.h"

#include <cstddef>
#include <system_error>

#include "scenarios/document.h"
#include "scenarios/input_file.h"

namespace simbench::reports {

std::optional<std::string> content_of(const std::filesystem::path& path) {
  constexpr std::size_t kLargest = std::size_t{512} << 20;
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return std::nullopt;
  try {
    return file_content(path.string(), kLargest);
  } catch (const FileError& error) {
    scenarios::fail_to_read(scenarios::shown_text(path.string()), error.what());
  }
}

}  // namespace simbench::reports
