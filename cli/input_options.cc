#include "cli/input_options.h"

#include <cstdint>

#include "app/interrupt.h"
#include "app/recorded_streams.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "recording/recording.h"

namespace simbench::cli {

void add_input_options(Command& command, InputOptions& options) {
  command.list("--topics", "TOPIC,...", options.topics,
               "Of bags only these topics. Default: those that look like a camera's");
  command.text("--columns", "FIELD=COLUMN,...", options.columns,
               "Of CSV files: which columns are sensor, arrival, counter, stream, index, camera,\n"
               "host. After a column's name may stand :ns, :us, :ms (the default) or :s");
}

bags::FileOptions file_options(const InputOptions& options) {
  bags::FileOptions files{.topics = options.topics};
  if (!options.columns.empty()) files.columns = RecordingColumns::parse(options.columns);
  return files;
}

std::optional<RecordedStreams> read_inputs(const std::vector<std::string>& inputs,
                                           const InputOptions& options) {
  constexpr unsigned kMegabyte = 20;
  constexpr std::uint64_t kFewMegabytes = 16;
  const bags::FileOptions files = file_options(options);
  auto found = watched<RecordedStreams>(
      [&](const evaluation::Progress& progress) {
        return app::recorded_streams(inputs, files, [&](std::uint64_t done, std::uint64_t total) {
          const std::uint64_t all = total >> kMegabyte;
          if (all >= kFewMegabytes) progress(done >> kMegabyte, all);
          if (app::InterruptHandler::raised()) throw RecordingCancelled();
        });
      },
      {.unit = "megabyte"});
  if (!found) return std::nullopt;
  for (const std::string& note : found->notes) print_note(note);
  return found;
}

}  // namespace simbench::cli
