// The faults that a diagnosis names, the most harmful first: what the cause is, which numbers show
// it, what to do, and how sure that is.
//
//   Diagnosis diagnosis = diagnose(recorded.streams, {});
//   diagnosis.findings = findings_of(diagnosis);   // everything else is filled in
//
// Complexity: O(n) in the cameras for each, with few jumps.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"

namespace simbench::evaluation {

std::vector<Finding> findings_of(const Diagnosis& diagnosis);

// Where the findings of one camera's stream go.
class CameraFindings {
 public:
  CameraFindings(const Diagnosis& all, const CameraDiagnosis& of, std::vector<Finding>& list)
      : diagnosis(all), camera(of), list_(list) {}

  struct Kind {
    const char* name = "";
    Harm harm = Harm::kMinor;
    FindingCertainty certainty = FindingCertainty::kCertain;
    bool in_verdict = false;
  };
  // `text`: without the camera's name.
  void add(const Kind& kind, std::string_view text, std::string advice = {});

  const GroupVerdict& group() const;
  // The camera that phases and rates are relative to; empty without one.
  std::string reference() const;
  bool is_reference() const { return reference() == camera.camera; }

  const Diagnosis& diagnosis;
  const CameraDiagnosis& camera;

 private:
  std::vector<Finding>& list_;
};

// Stamps and clocks (stamp_findings.cc); frames and their delivery (frame_findings.cc).
void add_stamp_findings(CameraFindings& found);
void add_frame_findings(CameraFindings& found);

}  // namespace simbench::evaluation
