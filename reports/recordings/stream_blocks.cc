#include "reports/recordings/stream_blocks.h"

#include <utility>

#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/frame_account.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraStatistics;
using evaluation::FrameAccount;

Json period_json(const evaluation::PeriodStatistics& period) {
  return {{"mean", period.mean_ms}, {"sd", period.sd_ms}};
}

Json residual_json(const evaluation::ResidualStatistics& residual) {
  return {{"sd", residual.sd_ms},
          {"p95", residual.p95_ms},
          {"p99", residual.p99_ms},
          {"max", residual.max_ms}};
}

}  // namespace

Block frames_block(const std::vector<RecordedStream>& streams) {
  Table table({{"camera", Align::kLeft},
               {"stream", Align::kLeft},
               {"delivered"},
               {.header = "lost", .legend = "counted by the camera, but never arrived"},
               {.header = "never\nexposed", .legend = "periods that the camera did not count"},
               {.header = "unknown", .legend = "missing periods of which no counter tells"}},
              2);
  for (const RecordedStream& stream : streams) {
    const FrameAccount account = evaluation::frame_account(stream);
    table.add({stream.camera, stream.stream, count_text(account.delivered),
               stream.counted ? count_text(account.lost) : "uncounted",
               stream.counted ? count_text(account.never_exposed) : "uncounted",
               count_text(account.unknown)});
  }
  return {.heading = "Frames, from the first to the last", .table = std::move(table)};
}

Block clocks_block(const std::vector<RecordedStream>& streams) {
  Table table({{"camera", Align::kLeft},
               {"stream", Align::kLeft},
               {"sensor period\nms"},
               {"\nsd ms"},
               {"arrival period\nms"},
               {"\nsd ms"},
               {"drift\nppm"},
               {"by envelope\nppm"},
               {"residual ms\nsd"},
               {"excess ms\n50 %"},
               {"\n95 %"},
               {"\n99 %"},
               {"\nmax"}},
              2);
  for (const RecordedStream& stream : streams) {
    const CameraStatistics s = evaluation::camera_statistics(evaluation::unwrapped(stream.frames));
    table.add({stream.camera, stream.stream, decimals_text(s.sensor_period.mean_ms, 4),
               decimals_text(s.sensor_period.sd_ms, 4), decimals_text(s.arrival_period.mean_ms, 4),
               number_text(s.arrival_period.sd_ms), decimals_text(s.drift_ppm, 3),
               decimals_text(s.envelope_drift_ppm, 3), number_text(s.residual.sd_ms),
               number_text(s.excess.p50_ms), number_text(s.excess.p95_ms),
               number_text(s.excess.p99_ms), number_text(s.excess.max_ms)});
  }
  return {
      .heading = "The cameras' clocks",
      .table = std::move(table),
      .prose = {"The drift is host rate / device rate - 1, by least squares; by envelope, by the "
                "earliest frames. The excess is the delay of the arrivals over the earliest "
                "frames."}};
}

Json clocks_json(const RecordedStream& stream) {
  const CameraStatistics found =
      evaluation::camera_statistics(evaluation::unwrapped(stream.frames));
  return {{"long_intervals", found.long_intervals},
          {"sensor_period_ms", period_json(found.sensor_period)},
          {"arrival_period_ms", period_json(found.arrival_period)},
          {"drift_ppm", found.drift_ppm},
          {"envelope_drift_ppm", found.envelope_drift_ppm},
          {"residual_ms", residual_json(found.residual)},
          {"excess_ms",
           {{"mean", found.excess.mean_ms},
            {"p50", found.excess.p50_ms},
            {"p95", found.excess.p95_ms},
            {"p99", found.excess.p99_ms},
            {"max", found.excess.max_ms}}}};
}

Block stamps_block(const std::vector<evaluation::StampedStream>& stamps) {
  Table table({{"camera", Align::kLeft},
               {"stream", Align::kLeft},
               {"device_time", Align::kLeft},
               {"jitter\nms"},
               {"residual ms\nsd"},
               {"\n95 %"},
               {"\n99 %"},
               {"\nmax"},
               {"drift\nppm"}},
              3);
  for (const evaluation::StampedStream& stamped : stamps) {
    const evaluation::StampStatistics s = evaluation::stamp_statistics(stamped);
    table.add({stamped.stream->camera, stamped.stream->stream, stamped.device_time,
               number_text(s.jitter_ms), number_text(s.residual.sd_ms),
               number_text(s.residual.p95_ms), number_text(s.residual.p99_ms),
               number_text(s.residual.max_ms), number_text(s.drift_ppm)});
  }
  return {.heading = "Global stamps by device_time",
          .table = std::move(table),
          .prose = {"The jitter is the standard deviation of (interval of global stamps - interval "
                    "of sensor stamps). The residual is arrival minus global stamp, less its mean: "
                    "the delay by the estimator."}};
}

Json stamps_json(const evaluation::StampedStream& stamped) {
  const evaluation::StampStatistics s = evaluation::stamp_statistics(stamped);
  return {{"camera", stamped.stream->camera},         {"stream", stamped.stream->stream},
          {"device_time", stamped.device_time},       {"jitter_ms", s.jitter_ms},
          {"residual_ms", residual_json(s.residual)}, {"drift_ppm", s.drift_ppm}};
}

}  // namespace simbench::reports
