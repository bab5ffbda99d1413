// Recordings of real cameras for the package: replay and diagnosis.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "app/recorded_streams.h"
#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/replay/replay.h"
#include "python/src/bindings.h"
#include "python/src/rows.h"
#include "python/src/work.h"
#include "reports/page/diagnose_page.h"
#include "reports/rigs/diagnose_report.h"
#include "reports/rigs/replay_report.h"
#include "scenarios/loader.h"

namespace py = pybind11;

namespace simbench::python {
namespace {

using evaluation::Progress;

struct ReplayedFiles {
  evaluation::Replay replay{};
  std::vector<std::string> files{};
  std::vector<std::string> notes{};
};

struct DiagnosedFiles {
  evaluation::Diagnosis diagnosis{};
  std::vector<std::string> files{};
  std::vector<std::string> notes{};
};

void stop_if_interrupted() {
  if (app::InterruptHandler::raised()) throw RecordingCancelled();
}

RecordedStreams streams_of(const std::vector<std::string>& files, const py::object& on_progress) {
  return watched<RecordedStreams>(on_progress,
                                  [&](const Progress&) { return app::recorded_streams(files); });
}

std::shared_ptr<ReplayedFiles> replay_files(const std::vector<std::string>& files,
                                            const py::object& on_progress) {
  RecordedStreams rig = streams_of(files, on_progress);
  auto replayed = std::make_shared<ReplayedFiles>();
  replayed->files = files;
  replayed->notes = std::move(rig.notes);
  replayed->replay = watched<evaluation::Replay>(on_progress, [&](const Progress& progress) {
    return evaluation::run_replay(std::move(rig.streams),
                                  [&](std::uint64_t done, std::uint64_t total) {
                                    progress(done, total);
                                    stop_if_interrupted();
                                  });
  });
  const std::vector<std::string>& more = replayed->replay.warnings;
  replayed->notes.insert(replayed->notes.end(), more.begin(), more.end());
  return replayed;
}

// The places of these device_times among a camera's rows. Throws InputError for one that is not
// there or did not run.
std::vector<std::size_t> places_of(const evaluation::CameraReplay& camera,
                                   const std::vector<std::string>& device_times) {
  std::vector<std::size_t> places;
  for (const std::string& name : device_times) {
    const auto row =
        std::ranges::find(camera.rows, name, &evaluation::DeviceTimeReplay::device_time);
    if (row != camera.rows.end() && !row->needs_polls) {
      places.push_back(static_cast<std::size_t>(row - camera.rows.begin()));
      continue;
    }
    std::vector<std::string> known;
    for (const auto& each : camera.rows) {
      if (!each.needs_polls) known.push_back(each.device_time);
    }
    throw scenarios::InputError(
        fmt::format("device_times: found '{}', allowed: {}", name, fmt::join(known, ", ")));
  }
  return places;
}

// Every frame, a row each of 8-byte cells: camera (its place), counter, stamps, and the global
// stamps by these device_times.
Rows replayed_frames(const ReplayedFiles& of, const std::vector<std::string>& device_times) {
  constexpr std::size_t kCell = sizeof(std::int64_t);
  std::vector<RowField> fields = {{"camera", "<i8", 0},
                                  {"counter", "<u8", kCell},
                                  {"sensor_ns", "<i8", 2 * kCell},
                                  {"arrival_ns", "<i8", 3 * kCell}};
  for (const std::string& name : device_times) {
    fields.push_back({"global_ms_" + name, "<f8", fields.size() * kCell});
  }
  std::size_t frames = 0;
  for (const auto& camera : of.replay.cameras) frames += camera.frames.size();
  std::vector<std::int64_t> cells;
  cells.reserve(frames * fields.size());
  for (std::size_t i = 0; i < of.replay.cameras.size(); ++i) {
    const evaluation::CameraReplay& camera = of.replay.cameras[i];
    const std::vector<std::size_t> places = places_of(camera, device_times);
    std::optional<evaluation::GlobalStamps> stamps;
    if (!places.empty()) stamps.emplace(camera);
    for (const StampedFrame& frame : camera.frames) {
      cells.insert(cells.end(),
                   {static_cast<std::int64_t>(i), static_cast<std::int64_t>(frame.counter),
                    frame.sensor.count(), frame.arrival.count()});
      if (!stamps) continue;
      const std::vector<std::optional<GlobalTime>>& global = stamps->next();
      for (const std::size_t place : places) {
        const double ms =
            global[place] ? to_ms(global[place]->time_since_epoch()) : evaluation::kNan;
        cells.push_back(std::bit_cast<std::int64_t>(ms));
      }
    }
  }
  const std::size_t row_bytes = fields.size() * kCell;
  return Rows(std::move(cells), std::move(fields), row_bytes);
}

py::list cameras_of(const ReplayedFiles& of) {
  py::list cameras;
  for (const auto& camera : of.replay.cameras) {
    cameras.append(py::dict(py::arg("camera") = camera.camera, py::arg("host") = camera.host,
                            py::arg("stream") = camera.stream));
  }
  return cameras;
}

std::shared_ptr<DiagnosedFiles> diagnose_files(const std::vector<std::string>& files,
                                               std::optional<double> rate_hz, bool one_host,
                                               const py::object& on_progress) {
  RecordedStreams rig = streams_of(files, on_progress);
  auto diagnosed = std::make_shared<DiagnosedFiles>();
  diagnosed->files = files;
  diagnosed->notes = std::move(rig.notes);
  diagnosed->diagnosis = watched<evaluation::Diagnosis>(on_progress, [&](const Progress&) {
    return evaluation::diagnose(rig.streams, {.rate_hz = rate_hz, .one_host = one_host});
  });
  return diagnosed;
}

std::string page_of(const DiagnosedFiles& of, const std::vector<std::string>& command) {
  return reports::diagnose_html(
      {.diagnosis = of.diagnosis, .inputs = of.files, .command = command});
}

}  // namespace
}  // namespace simbench::python

void bind_recordings(pybind11::module_& module) {
  using namespace simbench;
  using python::DiagnosedFiles;
  using python::ReplayedFiles;
  py::class_<ReplayedFiles, std::shared_ptr<ReplayedFiles>>(module, "Replay")
      .def_readonly("notes", &ReplayedFiles::notes)
      .def_property_readonly("cameras", &python::cameras_of)
      .def("csv", [](const ReplayedFiles& of) { return reports::replay_csv(of.replay); })
      .def("json",
           [](const ReplayedFiles& of) { return reports::replay_json(of.replay, of.files); })
      .def("text", [](const ReplayedFiles& of) { return reports::replay_table(of.replay); })
      .def("frames", &python::replayed_frames, py::call_guard<py::gil_scoped_release>());
  py::class_<DiagnosedFiles, std::shared_ptr<DiagnosedFiles>>(module, "Diagnosis")
      .def_readonly("notes", &DiagnosedFiles::notes)
      .def("json",
           [](const DiagnosedFiles& of) { return reports::diagnose_json(of.diagnosis, of.files); })
      .def("text",
           [](const DiagnosedFiles& of) { return plain(reports::diagnose_document(of.diagnosis)); })
      .def("html",
           [](const DiagnosedFiles& of) {
             return html(reports::diagnose_document(of.diagnosis).blocks);
           })
      .def("head",
           [](const DiagnosedFiles& of) { return reports::diagnose_document(of.diagnosis).head; })
      .def("page", &python::page_of);
  module.def("replay_files", &python::replay_files);
  module.def("diagnose_files", &python::diagnose_files);
}
