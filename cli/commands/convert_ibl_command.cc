#include "cli/commands/convert_ibl_command.h"

#include <memory>

#include "app/ibl_recording.h"
#include "cli/exit_status.h"

namespace simbench::cli {
namespace {

constexpr const char* kExplanation = R"(
Reads _iblrig_*.timestamps.ssv (ISO time of arrival, cycle clock) and _iblrig_*.frameData.bin (rows
of four 64-bit floats: host ticks, cycle clock, frame counter, GPIO) and prints the CSV that
`simbench replay` takes. The camera's cycle clock starts again every 128 s; in the CSV it goes on.

Example:
  simbench convert-ibl _iblrig_bodyCamera.timestamps.ssv > body.csv
  simbench replay body.csv)";

}  // namespace

void add_convert_ibl_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "convert-ibl", "Convert a recording of an IBL camera rig to the CSV of `simbench replay`");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "*.timestamps.ssv or *.frameData.bin")
      ->type_name("FILE")
      ->required();
  command->footer(kExplanation);
  command->callback([file, &action] {
    action = [file] {
      print_result(app::rs_csv_text(app::read_ibl_recording(*file)));
      return static_cast<int>(kOk);
    };
  });
}

}  // namespace simbench::cli
