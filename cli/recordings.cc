#include "cli/recordings.h"

#include <algorithm>

namespace simbench::cli {

std::vector<CameraStream> read_recordings(const std::vector<std::string>& files) {
  CsvRecordingReader reader;
  for (auto file = files.begin(); file != files.end(); ++file) {
    if (std::find(files.begin(), file, *file) != file) throw CsvError(*file + ": given twice");
    reader.read_file(*file);
  }
  return reader.take();
}

}  // namespace simbench::cli
