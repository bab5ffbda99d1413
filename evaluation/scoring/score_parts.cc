#include "evaluation/scoring/score_parts.h"

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "evaluation/scoring/pulse_scores.h"

namespace simbench::evaluation {

void AlignmentPart::on_frames(std::span<const FrameRecord> frames,
                              std::span<const FrameTruth> truths) {
  for (std::size_t i = 0; i < truths.size(); ++i) {
    if (frames[i].stream == stream_) scores_.add(frames[i], truths[i]);
  }
}

void AlignmentPart::on_event(const RecordingEvent& event) {
  if (const auto* report = std::get_if<AlignmentReport>(&event)) scores_.add(*report);
}

void AlignmentPart::add_to(SeedScore& score) {
  scores_.add_to(score);
  const std::string problem = scores_.problem();
  if (problem.empty()) return;
  score.cost.notes.push_back("capture_alignment left a camera unaligned: " + problem);
}

void ColourPart::on_frames(std::span<const FrameRecord> frames,
                           std::span<const FrameTruth> truths) {
  for (std::size_t i = 0; i < truths.size(); ++i) offsets_.add(frames[i], truths[i]);
}

SecondAmd::SecondAmd(const EstimatorFactory& make, const RigLayout& layout, Stamping& stamping,
                     const KeptFrames& kept)
    : bank_(make_bank(make, layout.cameras.size())),
      first_pulse_(layout.first_pulse),
      pulses_(layout.pulses),
      kept_(kept) {
  stamping.inform(*bank_);
}

void SecondAmd::add_to(SeedScore& score) {
  PulseRanges ranges(first_pulse_, pulses_);
  std::vector<GlobalTime> stamps;
  for (std::uint32_t camera = 0; camera < kept_.cameras(); ++camera) {
    const std::span<const DeviceSample> samples = kept_.samples(camera);
    if (samples.empty()) continue;
    bank_->at(camera).learn(samples);
    stamps.resize(samples.size());
    bank_->stamp(std::vector(samples.size(), camera), samples, stamps);
    const std::span<const KeptFrames::Delivery> deliveries = kept_.deliveries(camera);
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      ranges.add(camera, deliveries[i].pulse, stamps[i]);
    }
  }
  score.offline_amd_ms = ranges.amd_ms(kept_.cameras());
}

}  // namespace simbench::evaluation
