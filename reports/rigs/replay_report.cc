#include "reports/rigs/replay_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "recording/decimal.h"
#include "reports/results/csv.h"
#include "reports/text/block.h"
#include "reports/text/number_text.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraReplay;
using evaluation::CameraStatistics;
using evaluation::DeviceTimeReplay;
using evaluation::GatheringReplay;
using evaluation::Replay;
using evaluation::RigReplay;
using evaluation::RigRow;

bool has_other_streams(const Replay& replay, const CameraReplay& camera) {
  return std::any_of(replay.cameras.begin(), replay.cameras.end(), [&](const CameraReplay& other) {
    return other.camera == camera.camera && other.stream != camera.stream;
  });
}

std::string name_of(const Replay& replay, const CameraReplay& camera) {
  if (!has_other_streams(replay, camera)) return camera.camera;
  return camera.camera + "/" + camera.stream;
}

std::string cameras_text(const Replay& replay) {
  Table table({{"camera", Align::kLeft},
               {"host", Align::kLeft},
               {"frames"},
               {"missing"},
               {"span\ns"},
               {"sensor period\nms"},
               {"\nsd ms"},
               {"arrival period\nms"},
               {"\nsd ms"},
               {"drift\nppm"},
               {"by envelope\nppm"},
               {"excess ms\n50 %"},
               {"\n95 %"},
               {"\n99 %"},
               {"\nmax"}});
  for (const CameraReplay& camera : replay.cameras) {
    const CameraStatistics& s = camera.statistics;
    table.add({name_of(replay, camera), camera.host, count_text(s.frames),
               count_text(s.missing_frames), number_text(s.span_s),
               number_text(s.sensor_period.mean_ms), fmt::format("{:.4f}", s.sensor_period.sd_ms),
               number_text(s.arrival_period.mean_ms), number_text(s.arrival_period.sd_ms),
               fmt::format("{:.3f}", s.drift_ppm), fmt::format("{:.3f}", s.envelope_drift_ppm),
               number_text(s.excess.p50_ms), number_text(s.excess.p95_ms),
               number_text(s.excess.p99_ms), number_text(s.excess.max_ms)});
  }
  return plain(table);
}

std::string rows_text(const Replay& replay) {
  Table table({{"camera", Align::kLeft},
               {"device_time", Align::kLeft},
               {"jitter\nms"},
               {"residual ms\nsd"},
               {"\n95 %"},
               {"\n99 %"},
               {"\nmax"},
               {"drift\nppm"}},
              2);
  for (const CameraReplay& camera : replay.cameras) {
    for (const DeviceTimeReplay& row : camera.rows) {
      table.add({name_of(replay, camera), row.device_time, number_text(row.jitter_ms),
                 number_text(row.residual.sd_ms), number_text(row.residual.p95_ms),
                 number_text(row.residual.p99_ms), number_text(row.residual.max_ms),
                 number_text(row.drift_ppm)});
    }
  }
  return plain(table);
}

std::string rig_text(const RigReplay& rig) {
  std::string text = fmt::format(
      "\n{} of {} cameras, unverified (a recording has no ground truth)\n"
      "  GenLock order finds {} complete pulses, period {} ms. It counts from the first frames, "
      "which "
      "arrived within {} ms:\n  {}\n\n",
      rig.stream, rig.cameras.size(), count_text(rig.complete_pulses), number_text(rig.period_ms),
      number_text(rig.first_arrival_range_ms),
      rig.common_start_plausible
          ? "less than half a period, as after a common start."
          : "half a period or more, so without a common start; its AMD and RMDV mean nothing.");
  Table table({{"device_time", Align::kLeft},
               {"frames matched by", Align::kLeft},
               {"sets"},
               {"frames\ndiscarded"},
               {"AMD\nms"},
               {"RMDV\nms"}},
              2);
  for (const RigRow& row : rig.rows) {
    table.add({row.device_time, "GenLock order", count_text(rig.complete_pulses), "-",
               number_text(row.amd_ms), number_text(row.rmdv_ms)});
    for (const GatheringReplay& found : row.gatherings) {
      table.add({"", found.gathering, count_text(found.sets), count_text(found.discarded_frames),
                 number_text(found.amd_ms), number_text(found.rmdv_ms)});
    }
  }
  return text + plain(table);
}

constexpr const char* kReplayLegend = R"(
How to read it
  host_sync cannot be replayed: it had its effect on the clocks that stamped the arrivals.
  drift: (host rate / device rate - 1) in ppm, by least squares; by envelope: by the earliest frames.
  excess: how much later than the earliest frames the others arrived. missing: by the frame counter.
  jitter: standard deviation of (interval of global stamps - interval of sensor stamps).
  residual: arrival minus global stamp, mean taken off: what the estimator takes for delay.
)";

void append_ms(fmt::memory_buffer& text, Nanoseconds time) {
  text.push_back(',');
  const std::string ms = simbench::ms_text(time);
  text.append(ms.data(), ms.data() + ms.size());
}

}  // namespace

std::string replay_table(const Replay& replay) {
  std::string text = "The cameras and their clocks\n\n" + cameras_text(replay) +
                     "\nGlobal stamps, by estimator\n\n" + rows_text(replay);
  for (const RigReplay& rig : replay.rigs) text += rig_text(rig);
  return fitted(text + kReplayLegend);
}

std::string replay_csv(const Replay& replay) {
  std::string text =
      "camera,stream,device_time,jitter_ms,residual_sd_ms,residual_p95_ms,residual_p99_ms,"
      "residual_max_ms,drift_ppm\n";
  for (const CameraReplay& camera : replay.cameras) {
    for (const DeviceTimeReplay& row : camera.rows) {
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", csv_cell(camera.camera),
                          csv_cell(camera.stream), csv_cell(row.device_time),
                          csv_cell(row.jitter_ms), csv_cell(row.residual.sd_ms),
                          csv_cell(row.residual.p95_ms), csv_cell(row.residual.p99_ms),
                          csv_cell(row.residual.max_ms), csv_cell(row.drift_ppm));
    }
  }
  return text;
}

void write_replay_frames(const Replay& replay, std::ostream& out) {
  out << "camera,frame,sensor_ms,arrival_ms";
  if (replay.cameras.empty()) return;
  for (const DeviceTimeReplay& row : replay.cameras.front().rows) {
    out << ",global_ms_" << csv_cell(row.device_time);
  }
  out << '\n';
  fmt::memory_buffer text;
  for (const CameraReplay& camera : replay.cameras) {
    const std::string name = csv_cell(name_of(replay, camera));
    for (std::size_t i = 0; i < camera.frames.size(); ++i) {
      text.clear();
      fmt::format_to(std::back_inserter(text), "{},{}", name, camera.frames[i].counter);
      append_ms(text, camera.frames[i].sensor);
      append_ms(text, camera.frames[i].arrival);
      for (const DeviceTimeReplay& row : camera.rows) {
        append_ms(text, row.stamps[i].time_since_epoch());
      }
      text.push_back('\n');
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
    }
  }
}

}  // namespace simbench::reports
