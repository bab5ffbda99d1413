#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/rigs/replay_report.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;  // keeps members in order; writes NaN as null

Json period_json(const evaluation::PeriodStatistics& period) {
  return {{"mean", period.mean_ms}, {"sd", period.sd_ms}};
}

Json residual_json(const evaluation::ResidualStatistics& residual) {
  return {{"sd", residual.sd_ms},
          {"p95", residual.p95_ms},
          {"p99", residual.p99_ms},
          {"max", residual.max_ms}};
}

Json camera_json(const evaluation::CameraReplay& camera) {
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

Json row_json(const evaluation::CameraReplay& camera, const evaluation::DeviceTimeReplay& row) {
  return {{"camera", camera.camera},
          {"stream", camera.stream},
          {"device_time", row.device_time},
          {"jitter_ms", row.jitter_ms},
          {"residual_ms", residual_json(row.residual)},
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
    root["cameras"].push_back(camera_json(camera));
    for (const evaluation::DeviceTimeReplay& row : camera.rows) {
      root["rows"].push_back(row_json(camera, row));
    }
  }
  for (const evaluation::RigReplay& rig : replay.rigs) {
    root["rigs"].push_back(rig_json(replay, rig));
  }
  // A file may name its cameras in bytes that are no UTF-8.
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace simbench::reports
