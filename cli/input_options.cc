#include "cli/input_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>

#include "app/interrupt.h"
#include "app/recorded_streams.h"
#include "cli/messages.h"
#include "recording/recording.h"

namespace simbench::cli {

void add_input_options(Command& command, InputOptions& options) {
  command.list("--topics", "TOPIC,...", options.topics,
               "Of bags only these topics. Default: those that look like a camera's");
  command.text("--columns", "FIELD=COLUMN,...", options.columns,
               "Of CSV files: which columns are sensor, arrival, counter, stream, index, camera,\n"
               "host, exposure, backend, bytes, temperature. After a column's name may stand\n"
               ":ns, :us, :ms (the default) or :s");
}

bags::FileOptions file_options(const InputOptions& options) {
  bags::FileOptions files{.topics = options.topics};
  if (!options.columns.empty()) files.columns = RecordingColumns::parse(options.columns);
  return files;
}

std::vector<std::string> reading_words(const InputOptions& options) {
  std::vector<std::string> words;
  if (!options.topics.empty()) {
    words.insert(words.end(), {"--topics", fmt::format("{}", fmt::join(options.topics, ","))});
  }
  if (!options.columns.empty()) words.insert(words.end(), {"--columns", options.columns});
  return words;
}

ReadProgress read_progress(const evaluation::Progress& progress) {
  constexpr std::uint64_t kFewBytes = 1'000'000;
  return [&progress](std::uint64_t done, std::uint64_t total) {
    if (total >= kFewBytes) progress(done, total);
    if (app::InterruptHandler::raised()) throw RecordingCancelled();
  };
}

std::optional<RecordedStreams> read_inputs(const std::vector<std::string>& inputs,
                                           const InputOptions& options) {
  const bags::FileOptions files = file_options(options);
  auto found = watched_reading<RecordedStreams>(
      [&](const ReadProgress& progress) { return app::recorded_streams(inputs, files, progress); });
  if (!found) return std::nullopt;
  for (const std::string& note : found->notes) print_note(note);
  return found;
}

}  // namespace simbench::cli
