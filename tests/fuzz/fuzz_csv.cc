// The CSV reader and the scoring of what it read: any bytes are either refused with a CsvError or
// scored without undefined behaviour.
#include <cstddef>
#include <cstdint>

#include "app/recordings.h"
#include "recording/rs_csv.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  simbench::CsvRecordingReader reader;
  try {
    reader.read_text({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  } catch (const simbench::CsvError&) {
    return 0;
  }
  const simbench::app::RecordedRun run({"fuzz.csv"}, {.streams = reader.take(), .notes = {}}, {});
  run.evaluate(run.chosen({}), {}, nullptr);
  return 0;
}
