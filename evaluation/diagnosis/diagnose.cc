#include "evaluation/diagnosis/diagnose.h"

#include <algorithm>
#include <cstddef>

#include "evaluation/diagnosis/diagnose_findings.h"

namespace simbench::evaluation {
namespace {

// Kinds of streams in order of occurrence, depth before all others: it is what triggers drive.
std::vector<std::string> kinds_of(const std::vector<CameraStream>& streams) {
  std::vector<std::string> kinds;
  for (const CameraStream& stream : streams) {
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
      members.push_back({camera.camera, camera.host, &camera.facts, &camera.standing});
    }
  }
  std::optional<double> period_ms;
  if (options.rate_hz) period_ms = 1000 / *options.rate_hz;
  return judge_group(kind, members, period_ms);
}

// Every other stream of a camera against the one of the first kind it has.
std::vector<PairDiagnosis> pairs_of(const std::vector<CameraStream>& streams,
                                    const std::vector<std::string>& kinds) {
  std::vector<PairDiagnosis> pairs;
  for (const CameraStream& stream : streams) {
    const CameraStream* first = &stream;
    const auto rank = [&kinds](const CameraStream& s) {
      return std::find(kinds.begin(), kinds.end(), s.stream);
    };
    for (const CameraStream& other : streams) {
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

}  // namespace

Diagnosis diagnose(const std::vector<CameraStream>& streams, const DiagnoseOptions& options) {
  Diagnosis diagnosis;
  for (const CameraStream& stream : streams) {
    diagnosis.cameras.push_back({.camera = stream.camera,
                                 .host = options.one_host ? "" : stream.host,
                                 .stream = stream.stream,
                                 .facts = stream_facts(stream.frames),
                                 .standing = {}});
  }
  const std::vector<std::string> kinds = kinds_of(streams);
  for (const std::string& kind : kinds) {
    diagnosis.groups.push_back(judge_kind(kind, diagnosis, options));
  }
  if (!diagnosis.groups.empty()) diagnosis.verdict = diagnosis.groups.front();
  diagnosis.pairs = pairs_of(streams, kinds);
  diagnosis.findings = findings_of(diagnosis);
  diagnosis.cannot_know = cannot_know(diagnosis);
  return diagnosis;
}

}  // namespace simbench::evaluation
