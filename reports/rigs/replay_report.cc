#include "reports/rigs/replay_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/text/block.h"
#include "reports/text/escaped_text.h"
#include "reports/text/json_node.h"
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

constexpr const char* kNeedsPolls = "needs polls";

bool has_other_streams(const Replay& replay, const CameraReplay& camera) {
  return std::any_of(replay.cameras.begin(), replay.cameras.end(), [&](const CameraReplay& other) {
    return other.camera == camera.camera && other.stream != camera.stream;
  });
}

std::string camera_name(const Replay& replay, const CameraReplay& camera) {
  if (!has_other_streams(replay, camera)) return camera.camera;
  return camera.camera + "/" + camera.stream;
}

// With so many decimals; "-" for NaN.
std::string clocks_text(const Replay& replay) {
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
    table.add({camera_name(replay, camera), camera.host, count_text(s.frames),
               count_text(s.missing_frames), number_text(s.span_s),
               decimals_text(s.sensor_period.mean_ms, 4), decimals_text(s.sensor_period.sd_ms, 4),
               decimals_text(s.arrival_period.mean_ms, 4), number_text(s.arrival_period.sd_ms),
               decimals_text(s.drift_ppm, 3), decimals_text(s.envelope_drift_ppm, 3),
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
      table.add({camera_name(replay, camera), row.device_time,
                 row.needs_polls ? kNeedsPolls : number_text(row.jitter_ms),
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
      "which arrived within {} ms:\n  {}\n\n",
      rig.stream, rig.cameras.size(), count_text(rig.complete_pulses),
      decimals_text(rig.period_ms, 4), number_text(rig.first_arrival_range_ms),
      rig.common_start_plausible
          ? "less than half a period, as after a common start."
          : "half a period or more, so without a common start; its AMD and RMDV are meaningless.");
  Table table({{"device_time", Align::kLeft},
               {"frames matched by", Align::kLeft},
               {"sets"},
               {"frames\ndiscarded"},
               {"AMD\nms"},
               {"RMDV\nms"}},
              2);
  for (const RigRow& row : rig.rows) {
    if (row.needs_polls) {
      table.add({row.device_time, kNeedsPolls, "-", "-", "-", "-"});
      continue;
    }
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
  excess: delay of the arrivals over the earliest frames. missing: by the frame counter.
  jitter: standard deviation of (interval of global stamps - interval of sensor stamps).
  residual: arrival minus global stamp, less its mean: the delay by the estimator.
  needs polls: of the cameras' clocks, which these files do not have.
)";

void append_ms(fmt::memory_buffer& text, Nanoseconds time) {
  text.push_back(',');
  const std::string ms = simbench::ms_text(time);
  text.append(ms.data(), ms.data() + ms.size());
}

Json period_json(const evaluation::PeriodStatistics& period) {
  return {{"mean", period.mean_ms}, {"sd", period.sd_ms}};
}

Json residual_json(const evaluation::ResidualStatistics& residual) {
  return {{"sd", residual.sd_ms},
          {"p95", residual.p95_ms},
          {"p99", residual.p99_ms},
          {"max", residual.max_ms}};
}

Json replayed_camera_json(const evaluation::CameraReplay& camera) {
  const evaluation::CameraStatistics& found = camera.statistics;
  return {{"camera", camera.camera},
          {"host", camera.host},
          {"stream", camera.stream},
          {"frames", found.frames},
          {"missing_frames", found.missing_frames},
          {"long_intervals", found.long_intervals},
          {"span_s", found.span_s},
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

Json replayed_row_json(const evaluation::CameraReplay& camera,
                       const evaluation::DeviceTimeReplay& row) {
  return {{"camera", camera.camera},        {"stream", camera.stream},
          {"device_time", row.device_time}, {"needs_polls", row.needs_polls},
          {"jitter_ms", row.jitter_ms},     {"residual_ms", residual_json(row.residual)},
          {"drift_ppm", row.drift_ppm}};
}

Json rig_row_json(const evaluation::RigRow& row) {
  Json gatherings = Json::array();
  for (const evaluation::GatheringReplay& found : row.gatherings) {
    gatherings.push_back({{"gathering", found.gathering},
                          {"sets", found.sets},
                          {"discarded_frames", found.discarded_frames},
                          {"amd_ms", found.amd_ms},
                          {"rmdv_ms", found.rmdv_ms}});
  }
  return {{"device_time", row.device_time},
          {"needs_polls", row.needs_polls},
          {"amd_ms", row.amd_ms},
          {"rmdv_ms", row.rmdv_ms},
          {"gathering", gatherings}};
}

Json rig_json(const evaluation::Replay& replay, const evaluation::RigReplay& rig) {
  Json cameras = Json::array();
  for (const std::size_t index : rig.cameras) cameras.push_back(replay.cameras[index].camera);
  Json rows = Json::array();
  for (const evaluation::RigRow& row : rig.rows) rows.push_back(rig_row_json(row));
  return {{"stream", rig.stream},
          {"cameras", cameras},
          {"period_ms", rig.period_ms},
          {"complete_pulses", rig.complete_pulses},
          {"first_arrival_range_ms", rig.first_arrival_range_ms},
          {"common_start_plausible", rig.common_start_plausible},
          {"verified", false},
          {"rows", rows}};
}

}  // namespace

std::string replay_table(const Replay& replay) {
  std::string text = "The cameras and their clocks\n\n" + clocks_text(replay) +
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
  if (!replay.cameras.empty()) {
    for (const DeviceTimeReplay& row : replay.cameras.front().rows) {
      out << ",global_ms_" << csv_cell(row.device_time);
    }
  }
  out << '\n';
  fmt::memory_buffer text;
  for (const CameraReplay& camera : replay.cameras) {
    const std::string name = csv_cell(camera_name(replay, camera));
    evaluation::GlobalStamps stamps(camera);
    for (const StampedFrame& frame : camera.frames) {
      text.clear();
      fmt::format_to(std::back_inserter(text), "{},{}", name, frame.counter);
      append_ms(text, frame.sensor);
      append_ms(text, frame.arrival);
      for (const std::optional<GlobalTime>& stamp : stamps.next()) {
        if (stamp) {
          append_ms(text, stamp->time_since_epoch());
        } else {
          text.push_back(',');
        }
      }
      text.push_back('\n');
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
    }
  }
}

std::string replay_json(const evaluation::Replay& replay, const std::vector<std::string>& files) {
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"files", files},
               {"notes", Json::array({"host_sync cannot be replayed"})},
               {"cameras", Json::array()},
               {"rows", Json::array()},
               {"rigs", Json::array()},
               {"warnings", replay.warnings}};
  for (const evaluation::CameraReplay& camera : replay.cameras) {
    root["cameras"].push_back(replayed_camera_json(camera));
    for (const evaluation::DeviceTimeReplay& row : camera.rows) {
      root["rows"].push_back(replayed_row_json(camera, row));
    }
  }
  for (const evaluation::RigReplay& rig : replay.rigs) {
    root["rigs"].push_back(rig_json(replay, rig));
  }
  // A file may name its cameras in bytes that are no UTF-8.
  return file_text(root);
}

}  // namespace simbench::reports
