// What each stage of the model rests on: the matrix that `simbench validate-model` prints.
//
// A simulator is as good as the evidence for its parts, and that differs from part to part. The
// experiment of six nodes behind a relay validates how transport and protocols are implemented; it
// has no cameras and no second oscillator. Sources are named in each line: a reader can look up
// what was measured, by whom, and what nobody has measured.
//
//   for (const StageEvidence& stage : model_evidence()) print(stage.stage, stage.why);
#ifndef SIMBENCH_EVALUATION_MODEL_EVIDENCE_H_
#define SIMBENCH_EVALUATION_MODEL_EVIDENCE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace simbench::evaluation {

enum class Evidence : std::uint8_t {
  kTheory,      // follows from arithmetic, or is tested against a closed form
  kExperiment,  // the real-network experiment of this project
  kRecording,   // stamps that a real camera or network left behind
  kPublished,   // figures or behaviour that others documented
  kAssumption,  // nobody measured it for this model
};

inline constexpr std::array<Evidence, 5> kAllEvidence = {Evidence::kTheory, Evidence::kExperiment,
                                                         Evidence::kRecording, Evidence::kPublished,
                                                         Evidence::kAssumption};

// "theory", "this experiment", "a real recording", "published figures", "assumption".
std::string_view name_of(Evidence evidence);

struct StageEvidence {
  std::string_view stage;
  std::array<bool, kAllEvidence.size()> rests_on;  // in the order of kAllEvidence
  std::string_view why;

  bool has(Evidence evidence) const { return rests_on[static_cast<std::size_t>(evidence)]; }
};

// In the order of the data's way through the model.
std::span<const StageEvidence> model_evidence();

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_MODEL_EVIDENCE_H_
