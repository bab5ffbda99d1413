// Which columns of a table of frames are what: as the user says, or as its heading and its numbers
// show.
//
// The unit of a column of stamps is the one behind its name, else that of its heading; ISO 8601
// needs none. Else it is found by size (stamps that count from 1970) or by rate (the only unit in
// which frames come 1 to 1000 times a second), and said in a note; where none fits, it must be
// stated. What a table has beside stamps (exposure, stamp of the back end, bytes, temperature) is
// found by its heading; an exposure is in microseconds where nothing says another unit.
//
//   const auto columns = RecordingColumns::parse("sensor=t_cam:us,arrival=t_host:ns,counter=seq");
//   std::vector<std::string> notes;
//   TableReader rows(LineReader("frames.csv"));
//   const ResolvedColumns found = resolve(columns, rows, notes);
//
// Errors: CsvError. Complexity: that of the first rows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "recording/recorded_streams.h"
#include "recording/stamp_unit.h"
#include "recording/table.h"

namespace simbench {

// A file that is no such recording. what() is the message for the user, "FILE:LINE: ...".
class CsvError : public RecordedFileError {
 public:
  using RecordedFileError::RecordedFileError;
};

enum class CsvField : std::uint8_t {
  kStream,
  kIndex,
  kCounter,
  kSensor,
  kArrival,
  kCamera,
  kHost,
  kExposure,
  kBackend,
  kBytes,
  kTemperature
};
inline constexpr std::size_t kCsvFields = 11;

struct RecordingColumns {
  struct Column {
    std::string name{};  // as in the heading, or a number from 1; blanks and capitals do not matter
    std::optional<StampUnit> unit{};
  };
  // By field; an empty name: none.
  std::array<Column, kCsvFields> columns{};
  // One row a set of frames: a column of stamps for each camera, which has its name.
  std::vector<Column> cameras{};

  // From "sensor=t_cam:us,arrival=t_host:ns,counter=seq": of stream, index, counter, sensor,
  // arrival, camera, host, exposure, backend, bytes and temperature. Several sensor= are a camera
  // each. Throws CsvError: "--columns: ...", also if the sensor's is missing.
  static RecordingColumns parse(const std::string& text);
  const Column& of(CsvField field) const { return columns[static_cast<std::size_t>(field)]; }
};

// Columns of one table, by position.
struct ResolvedColumns {
  struct Stamps {
    std::string name{};
    std::size_t position = 0;
    StampUnit unit{};
  };
  std::array<std::optional<std::size_t>, kCsvFields> position{};
  std::vector<Stamps> sensors{};  // at least one
  std::optional<Stamps> arrival{};
  std::optional<StampUnit> exposure_unit{};  // nothing: microseconds
  std::optional<Stamps> backend{};
};

// Notes say what was taken for granted, without the file's name.
ResolvedColumns resolve(const RecordingColumns& columns, const TableReader& table,
                        std::vector<std::string>& notes);
// For a table about which nothing is said: its only column of times, and a counter if one is called
// so. Throws CsvError, with what would be read.
ResolvedColumns found_columns(const TableReader& table, std::vector<std::string>& notes);

// Adds the columns beside stamps that nobody stated, by their headings.
void find_frame_columns(const std::vector<std::string>& heading, ResolvedColumns& found);

// The plain name: blanks, capitals and a mark of comments differ between versions of a tool.
std::string plain_column_name(std::string_view cell);

}  // namespace simbench
