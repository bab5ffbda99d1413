// Recordings of real cameras for the package: inspection and diagnosis.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/host_logs.h"
#include "app/inspection.h"
#include "app/recorded_streams.h"
#include "app/stream_run.h"
#include "cli/input_options.h"
#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/frames/camera_statistics.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "python/src/rows.h"
#include "python/src/work.h"
#include "reports/page/diagnose_page.h"
#include "reports/recordings/diagnose_report.h"
#include "reports/recordings/inspect_report.h"

namespace simbench::python {
namespace {

using evaluation::Progress;

struct InspectedFiles {
  std::vector<reports::Inspection> inspections{};
  RecordedStreams recorded{};
  std::vector<std::string> reading{};  // its options as words of a command line
};

struct DiagnosedFiles {
  evaluation::Diagnosis diagnosis{};
  std::vector<std::string> files{};
  std::vector<std::string> notes{};
};

RecordedStreams streams_of(const std::vector<std::string>& files, const bags::FileOptions& options,
                           const Object& on_progress) {
  return watched<RecordedStreams>(on_progress, [&](const Progress& progress) {
    return app::recorded_streams(files, options, cli::read_progress(progress));
  });
}

std::shared_ptr<InspectedFiles> inspect_files(const std::vector<std::string>& files,
                                              const std::vector<std::string>& topics,
                                              const std::string& columns,
                                              const std::vector<std::string>& device_times,
                                              const Object& on_progress) {
  const cli::InputOptions reading{.topics = topics, .columns = columns};
  const bags::FileOptions options = cli::file_options(reading);
  auto inspected = std::make_shared<InspectedFiles>();
  inspected->reading = cli::reading_words(reading);
  inspected->recorded = streams_of(files, options, on_progress);
  inspected->inspections =
      watched<std::vector<reports::Inspection>>(on_progress, [&](const Progress& progress) {
        return app::inspected(files, options, device_times, cli::read_progress(progress));
      });
  return inspected;
}

// Every frame, a row each of 8-byte cells: camera (its place among the streams), counter, stamps,
// and the global stamps by these device_times.
Rows stamped_frames(const InspectedFiles& of, const std::vector<std::string>& device_times) {
  constexpr std::size_t kCell = sizeof(std::int64_t);
  std::vector<RowField> fields = {{"camera", "<i8", 0},
                                  {"counter", "<u8", kCell},
                                  {"sensor_ns", "<i8", 2 * kCell},
                                  {"arrival_ns", "<i8", 3 * kCell}};
  for (const std::string& name : device_times) {
    fields.push_back({"global_ms_" + name, "<f8", fields.size() * kCell});
  }
  const std::vector<RecordedStream>& streams = of.recorded.streams;
  std::vector<evaluation::StampedStream> stamped;
  if (!device_times.empty()) stamped = app::stamped_streams(streams, device_times, "device_times");
  std::vector<std::int64_t> cells;
  auto next = stamped.begin();
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const auto begin = next;
    while (next != stamped.end() && next->stream == &streams[i]) ++next;
    const std::vector<StampedFrame> frames = evaluation::unwrapped(streams[i].frames);
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      cells.insert(cells.end(),
                   {static_cast<std::int64_t>(i), static_cast<std::int64_t>(frames[frame].counter),
                    frames[frame].sensor.count(), frames[frame].arrival.count()});
      for (std::size_t place = 0; place < device_times.size(); ++place) {
        const bool is_there = begin + static_cast<std::ptrdiff_t>(place) < next;
        const auto stamp = is_there ? begin[static_cast<std::ptrdiff_t>(place)].stamps[frame]
                                    : std::optional<GlobalTime>();
        const double ms = stamp ? to_ms(stamp->time_since_epoch()) : evaluation::kNan;
        cells.push_back(std::bit_cast<std::int64_t>(ms));
      }
    }
  }
  const std::size_t row_bytes = fields.size() * kCell;
  return Rows(std::move(cells), std::move(fields), row_bytes);
}

std::vector<Object> streams_list(const InspectedFiles& of) {
  std::vector<Object> streams;
  for (const RecordedStream& stream : of.recorded.streams) {
    streams.push_back(
        dict({{"camera", stream.camera}, {"host", stream.host}, {"stream", stream.stream}}));
  }
  return streams;
}

std::shared_ptr<DiagnosedFiles> diagnose_files(const std::vector<std::string>& files,
                                               const std::vector<std::string>& topics,
                                               const std::string& columns,
                                               std::optional<double> rate_hz, bool one_host,
                                               const std::vector<std::string>& clock_logs,
                                               const Object& on_progress) {
  const bags::FileOptions options = cli::file_options({.topics = topics, .columns = columns});
  RecordedStreams rig = streams_of(files, options, on_progress);
  auto diagnosed = std::make_shared<DiagnosedFiles>();
  diagnosed->files = files;
  diagnosed->notes = std::move(rig.notes);
  const app::HostLogs clocks = app::host_logs(clock_logs);
  diagnosed->notes.insert(diagnosed->notes.end(), clocks.notes.begin(), clocks.notes.end());
  diagnosed->diagnosis = watched<evaluation::Diagnosis>(on_progress, [&](const Progress&) {
    return evaluation::diagnose(
        rig.streams, {.rate_hz = rate_hz, .one_host = one_host, .clock_logs = clocks.logs});
  });
  return diagnosed;
}

std::string page_of(const DiagnosedFiles& of, const std::vector<std::string>& command) {
  return reports::diagnose_html(
      {.diagnosis = of.diagnosis, .inputs = of.files, .command = command});
}

}  // namespace

void bind_recordings(const Object& module) {
  using Inspected = InspectedFiles;
  add_class<Inspected>(
      module, "simbench._simbench.Inspection",
      {.properties = {property("notes", [](const Inspected& of) { return of.recorded.notes; }),
                      property("streams", callable<&streams_list>)},
       .methods = {
           method("json",
                  [](const Inspected& of) { return reports::inspect_json(of.inspections); }),
           method("text",
                  [](const Inspected& of) {
                    return plain(reports::inspect_document(of.inspections, of.reading));
                  }),
           method("frames", callable<&stamped_frames>)}});
  using Diagnosed = DiagnosedFiles;
  add_class<Diagnosed>(
      module, "simbench._simbench.Diagnosis",
      {.properties = {property("notes", [](const Diagnosed& of) { return of.notes; })},
       .methods = {method("json",
                          [](const Diagnosed& of) {
                            return reports::diagnose_json(of.diagnosis, of.files);
                          }),
                   method("text",
                          [](const Diagnosed& of) {
                            return plain(reports::diagnose_document(of.diagnosis));
                          }),
                   method("html",
                          [](const Diagnosed& of) {
                            return html(reports::diagnose_document(of.diagnosis).blocks);
                          }),
                   method("head",
                          [](const Diagnosed& of) {
                            return reports::diagnose_document(of.diagnosis).head;
                          }),
                   method("page", callable<&page_of>)}});
  add_functions(module, {function("inspect_files", callable<&inspect_files>),
                         function("diagnose_files", callable<&diagnose_files>)});
}

}  // namespace simbench::python
