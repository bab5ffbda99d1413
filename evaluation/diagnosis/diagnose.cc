#include "evaluation/diagnosis/diagnose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "evaluation/diagnosis/findings.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/stamp_grid.h"

namespace simbench::evaluation {
namespace {

// Kinds of streams in order of occurrence, depth before all others: it is what triggers drive.
std::vector<std::string> kinds_of(const std::vector<RecordedStream>& streams) {
  std::vector<std::string> kinds;
  for (const RecordedStream& stream : streams) {
    if (std::find(kinds.begin(), kinds.end(), stream.stream) == kinds.end()) {
      kinds.push_back(stream.stream);
    }
  }
  std::stable_partition(kinds.begin(), kinds.end(), [](const std::string& kind) {
    return kind.starts_with("Depth") || kind.starts_with("depth");
  });
  return kinds;
}

GroupVerdict judge_kind(const std::string& kind, Diagnosis& diagnosis,
                        const DiagnoseOptions& options) {
  std::vector<GroupMember> members;
  for (CameraDiagnosis& camera : diagnosis.cameras) {
    if (camera.stream == kind) {
      members.push_back(
          {camera.camera, camera.host, &camera.facts, &camera.scale, &camera.standing});
    }
  }
  std::optional<double> period_ms;
  if (options.rate_hz) period_ms = 1000 / *options.rate_hz;
  return judge_group(kind, members, period_ms);
}

// Compares every other stream of a camera with that of its first kind.
std::vector<PairDiagnosis> pairs_of(const std::vector<RecordedStream>& streams,
                                    const std::vector<std::string>& kinds) {
  std::vector<PairDiagnosis> pairs;
  for (const RecordedStream& stream : streams) {
    const RecordedStream* first = &stream;
    const auto rank = [&kinds](const RecordedStream& s) {
      return std::find(kinds.begin(), kinds.end(), s.stream);
    };
    for (const RecordedStream& other : streams) {
      if (other.camera == stream.camera && rank(other) < rank(*first)) first = &other;
    }
    if (first == &stream) continue;
    PairDiagnosis pair = compare_streams(stream.frames, first->frames);
    pair.camera = stream.camera;
    pair.stream = stream.stream;
    pair.against = first->stream;
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

// A camera whose own intervals show no grid may have too few frames of that of the others, which
// the steadiest one of its kind shows.
void place_on_others_grid(const std::vector<RecordedStream>& streams, Diagnosis& diagnosis) {
  const auto steadiness = [](const CameraDiagnosis& camera) {
    const double share = camera.facts.on_grid_share;
    return std::isnan(share) ? -1 : share;
  };
  for (std::size_t i = 0; i < streams.size(); ++i) {
    CameraDiagnosis& camera = diagnosis.cameras[i];
    if (!(camera.facts.on_grid_share < kMostOnGrid)) continue;
    const CameraDiagnosis* steadiest = &camera;
    for (const CameraDiagnosis& other : diagnosis.cameras) {
      const bool same = other.stream == camera.stream;
      if (same && steadiness(other) > steadiness(*steadiest)) steadiest = &other;
    }
    if (steadiest != &camera) {
      camera.facts = stream_facts(streams[i], steadiest->facts.period_ms);
    }
  }
}

// Arrivals that count from an epoch are what stamps are compared with; else the first camera's
// stamps are, if they do.
void note_scales(Diagnosis& diagnosis) {
  for (CameraDiagnosis& camera : diagnosis.cameras) camera.scale = stamp_scale(camera.facts);
  const auto needs = [](const CameraDiagnosis& camera) {
    return camera.scale.kind == ScaleKind::kOwnClock && camera.facts.global_time &&
           !camera.facts.one_clock;
  };
  const auto first = std::ranges::find_if(diagnosis.cameras, needs);
  if (first == diagnosis.cameras.end()) return;
  const double ahead_s = -first->facts.delay.least_ms * 1e-3;
  for (CameraDiagnosis& camera : diagnosis.cameras) {
    if (needs(camera) && camera.host == first->host) {
      camera.scale = stamp_scale(camera.facts, ahead_s);
    }
  }
}

// What logs of the hosts' clocks say beside these streams.
ClockAccount clocks_of(std::vector<RecordedStream> streams, const DiagnoseOptions& options) {
  ClockAccountOptions account;
  for (RecordedStream& stream : streams) {
    if (options.one_host) stream.host = streams.front().host;
    account.exposures_ms.push_back(stream.columns.exposure_us);
    for (double& exposure : account.exposures_ms.back()) exposure *= 1e-3;
  }
  return clock_account(streams, options.clock_logs, account);
}

// The questions about this rig that stamps cannot answer.
std::vector<std::string> cannot_know(const Diagnosis& diagnosis) {
  std::vector<std::string> texts = {
      "whether the exposures coincide: no stamp shows a constant delay before it was made (trigger "
      "cabling, exposure time, latency). Film one flash with all cameras once.",
      "which frames belong together: cameras with one period may still be whole periods apart."};
  if (std::any_of(diagnosis.cameras.begin(), diagnosis.cameras.end(),
                  [](const CameraDiagnosis& c) { return c.facts.stamped_by_host; })) {
    texts.emplace_back(
        "what the cameras' clocks say: header stamps are of a computer, which made them when a "
        "driver had the frame. Record the metadata topics, or with hardware stamps.");
  }
  if (std::any_of(diagnosis.cameras.begin(), diagnosis.cameras.end(),
                  [](const CameraDiagnosis& c) { return c.facts.one_clock; })) {
    texts.emplace_back(
        "the delays of frames: arrivals and sensor stamps are one column, so that there is one "
        "clock only. Record both.");
  }
  const std::string host = diagnosis.cameras.empty() ? "" : diagnosis.cameras.front().host;
  if (std::any_of(diagnosis.cameras.begin(), diagnosis.cameras.end(),
                  [&host](const CameraDiagnosis& camera) { return camera.host != host; })) {
    texts.emplace_back(
        "phases between hosts: they are as accurate as the hosts' common zero and clocks "
        "(--one-host: all files are of one computer).");
  }
  return texts;
}

}  // namespace

std::string called_camera(const std::string& name) {
  return name.starts_with("camera") ? name : "camera " + name;
}

Diagnosis diagnose(const std::vector<RecordedStream>& streams, const DiagnoseOptions& options) {
  Diagnosis diagnosis;
  for (const RecordedStream& stream : streams) {
    diagnosis.cameras.push_back({.camera = stream.camera,
                                 .host = options.one_host ? "" : stream.host,
                                 .stream = stream.stream,
                                 .facts = stream_facts(stream),
                                 .scale = {},
                                 .standing = {}});
  }
  place_on_others_grid(streams, diagnosis);
  note_scales(diagnosis);
  const std::vector<std::string> kinds = kinds_of(streams);
  for (const std::string& kind : kinds) {
    diagnosis.groups.push_back(judge_kind(kind, diagnosis, options));
  }
  if (!diagnosis.groups.empty()) diagnosis.verdict = diagnosis.groups.front();
  diagnosis.pairs = pairs_of(streams, kinds);
  if (!options.clock_logs.empty() && !streams.empty()) {
    diagnosis.clocks = clocks_of(streams, options);
  }
  diagnosis.findings = findings_of(diagnosis);
  diagnosis.cannot_know = cannot_know(diagnosis);
  return diagnosis;
}

}  // namespace simbench::evaluation
