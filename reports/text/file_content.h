// The whole content of a file of results.
//
//   const std::optional<std::string> text = content_of("sweep/runs.log");
#ifndef SIMBENCH_REPORTS_TEXT_FILE_CONTENT_H_
#define SIMBENCH_REPORTS_TEXT_FILE_CONTENT_H_

#include <filesystem>
#include <optional>
#include <string>

namespace simbench::reports {

// Nothing if there is no such file; errno has the reason. Throws scenarios::InputError for a file
// that cannot be read, and for one of more than 512 MiB.
std::optional<std::string> content_of(const std::filesystem::path& path);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_FILE_CONTENT_H_
