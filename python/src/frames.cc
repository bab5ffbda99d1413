#include "python/src/frames.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace simbench::python {
namespace {

struct FrameRow {
  std::int64_t pulse = -1;
  std::uint32_t camera = 0;
  std::uint32_t host = 0;
  std::uint32_t counter = 0;
  bool evaluated = false;
  bool in_warm_up = false;
  double sensor_ms = 0;
  double frame_ms = 0;
  double backend_ms = 0;
  double arrival_ms = 0;
  double global_ms = 0;
  double reference_ms = 0;
  double error_ms = 0;
  double exposure_start_ms = 0;
  double exposure_end_ms = 0;
};

std::vector<RowField> frame_fields() {
  return {{"camera", "<u4", offsetof(FrameRow, camera)},
          {"host", "<u4", offsetof(FrameRow, host)},
          {"counter", "<u4", offsetof(FrameRow, counter)},
          {"pulse", "<i8", offsetof(FrameRow, pulse)},
          {"evaluated", "?", offsetof(FrameRow, evaluated)},
          {"in_warm_up", "?", offsetof(FrameRow, in_warm_up)},
          {"sensor_ms", "<f8", offsetof(FrameRow, sensor_ms)},
          {"frame_ms", "<f8", offsetof(FrameRow, frame_ms)},
          {"backend_ms", "<f8", offsetof(FrameRow, backend_ms)},
          {"arrival_ms", "<f8", offsetof(FrameRow, arrival_ms)},
          {"global_ms", "<f8", offsetof(FrameRow, global_ms)},
          {"reference_ms", "<f8", offsetof(FrameRow, reference_ms)},
          {"error_ms", "<f8", offsetof(FrameRow, error_ms)},
          {"exposure_start_ms", "<f8", offsetof(FrameRow, exposure_start_ms)},
          {"exposure_end_ms", "<f8", offsetof(FrameRow, exposure_end_ms)}};
}

FrameRow row_of(const evaluation::FrameDetail& frame, std::uint32_t camera, std::uint32_t host) {
  return {.pulse = frame.pulse,
          .camera = camera,
          .host = host,
          .counter = frame.counter,
          .evaluated = frame.evaluated,
          .in_warm_up = frame.in_warm_up,
          .sensor_ms = frame.sensor_ms,
          .frame_ms = frame.frame_ms,
          .backend_ms = frame.backend_ms,
          .arrival_ms = frame.arrival_ms,
          .global_ms = frame.global_ms,
          .reference_ms = frame.reference_ms,
          .error_ms = frame.global_ms - frame.reference_ms,
          .exposure_start_ms = frame.exposure_start_ms,
          .exposure_end_ms = frame.exposure_end_ms};
}

}  // namespace

Rows frame_rows(evaluation::RunDetail detail) {
  std::size_t count = 0;
  for (const auto& camera : detail.cameras) count += camera.frames.size();
  std::vector<FrameRow> rows;
  rows.reserve(count);
  for (std::uint32_t camera = 0; camera < detail.cameras.size(); ++camera) {
    const std::vector<evaluation::FrameDetail> frames =
        std::exchange(detail.cameras[camera].frames, {});
    for (const auto& frame : frames) {
      rows.push_back(row_of(frame, camera, detail.cameras[camera].host));
    }
  }
  return Rows(std::move(rows), frame_fields());
}

}  // namespace simbench::python
