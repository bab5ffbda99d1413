#include "reports/text/file_content.h"

#include <fstream>
#include <iterator>

namespace simbench::reports {

std::optional<std::string> content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace simbench::reports
