// The whole content of a file.
//
//   const std::optional<std::string> text = content_of("sweep/runs.log");
#ifndef SIMBENCH_REPORTS_TEXT_FILE_CONTENT_H_
#define SIMBENCH_REPORTS_TEXT_FILE_CONTENT_H_

#include <filesystem>
#include <optional>
#include <string>

namespace simbench::reports {

// Nothing if the file cannot be opened; errno has the reason.
std::optional<std::string> content_of(const std::filesystem::path& path);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_FILE_CONTENT_H_
