#include <memory>

#include "app/ibl_recording.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "recording/rs_csv_text.h"

namespace simbench::cli {
namespace {

constexpr const char* kExplanation = R"(
Reads _iblrig_*.timestamps.ssv (ISO time of arrival, cycle clock) and _iblrig_*.frameData.bin (rows
of four 64-bit floats: host ticks, cycle clock, frame counter, GPIO) and prints the CSV that
`simbench replay` takes. The camera's cycle clock starts again every 128 s; the CSV has it
unwrapped.

Example:
  simbench convert-ibl _iblrig_bodyCamera.timestamps.ssv > body.csv
  simbench replay body.csv)";

}  // namespace

void add_convert_ibl_command(CommandLine& line) {
  auto file = std::make_shared<std::string>();
  Command command(line, "convert-ibl",
                  "Convert a recording of an IBL camera rig to the CSV of `simbench replay`");
  command.text("file", "FILE", *file, "*.timestamps.ssv or *.frameData.bin").required();
  command.footer(kExplanation);
  command.runs([file] {
    const RecordedStream stream = app::ibl_stream(app::read_ibl_recording(*file));
    print_result(rs_csv_text({&stream, 1}));
    return kOk;
  });
}

}  // namespace simbench::cli
