#include "app/bad_input.h"

#include <fmt/format.h>

#include <filesystem>

#include "bags/bag.h"
#include "recording/recording_folder.h"
#include "recording/rs_csv.h"
#include "reports/text/output_file.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

template <class... Errors>
bool is_any_of(const std::exception& error) {
  return (... || (dynamic_cast<const Errors*>(&error) != nullptr));
}

}  // namespace

std::optional<std::string> bad_input(const std::exception& error) {
  if (is_any_of<scenarios::InputError, reports::OutputError, CsvError, RecordingFolderError,
                bags::BagError>(error)) {
    return error.what();
  }
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return fmt::format("{}: {}", scenarios::shown_text(file->path1().string()),
                       file->code().message());
  }
  return std::nullopt;
}

}  // namespace simbench::app
