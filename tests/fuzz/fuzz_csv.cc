// The CSV reader and the replay of what it read: any bytes are either refused with a CsvError or
// replayed without undefined behaviour.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "evaluation/replay/replay.h"
#include "recording/rs_csv.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  simbench::CsvRecordingReader reader;
  try {
    reader.read_text({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  } catch (const simbench::CsvError&) {
    return 0;
  }
  simbench::evaluation::run_replay(reader.take());
  return 0;
}
