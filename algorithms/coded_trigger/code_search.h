// Looks for a camera's place in the trigger's code, frame by frame.
//
// Frames are held until they name one place:
//
//  - all other places together have at most the stated probability of error (Bayes);
//  - it is no chance: that frames which no code moved, uniform in what passes for a pulse, lie so
//    near to one of all places has at most the same probability. Each frame but two, which level
//    and rate take, counts ln(width / (noise * sqrt(2 pi e)));
//  - one frame whose stamp is wrong by as much as passes for a pulse would not have made another
//    place of it: every other place leaves a quarter more than the square of that. A sequence in
//    which any `order` symbols stand somewhere has no redundancy in so few.
//
// Frames must come as pulses do: two consecutive ones differ from whole periods by no more than the
// code, the clocks' rates and the noise allow. One that does not, as when the camera runs free or
// starts unsteadily, begins anew. The oldest frames are given up, one by one, while no place of the
// code explains all that are held, and when kMostHeld are held.
//
// Complexity: O(1) a frame until kFirstLook are held, then O(length), and as much for each frame
// that is given up. Memory: the correlator's. Nothing is allocated once it is made.
//
//   CodeSearch search(pulses, settings);
//   const CodeSearch::Outcome outcome = search.add(at_ns);
//   if (outcome.is_found) use(search.verdict().place + search.slot(0));
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/coded_trigger/code_correlator.h"
#include "algorithms/coded_trigger/coded_pulses.h"
#include "algorithms/parameter_binder.h"

namespace simbench {

struct CodeDecoderSettings {
  CodeNoise noise;
  double error_probability = 1e-9;  // of a place that is taken

  void bind(ParameterBinder& parameters);
};

// The smallest difference of two different shifts of the code; 0 if all are alike.
double smallest_step_us(const TriggerCode& code);
// More noise than this leaves shifts that cannot be told apart: the code does not explain it.
double most_noise_us(const TriggerCode& code, const CodeDecoderSettings& settings);

class CodeSearch {
 public:
  static constexpr std::size_t kFirstLook = 8;
  static constexpr std::size_t kMostHeld = 256;

  CodeSearch(std::shared_ptr<const CodedPulses> pulses, const CodeDecoderSettings& settings);

  struct Outcome {
    std::uint32_t given_up = 0;  // of the frames that were held, the oldest so many no longer are
    bool is_found = false;       // the place of those that are held
  };
  // The time of the frame's pulse on the camera's clock, but for a constant: later than the frame
  // that was added last.
  Outcome add(std::int64_t at_ns);
  void clear();

  std::size_t held() const { return points_.size(); }
  std::int64_t newest_at_ns() const { return newest_at_ns_; }
  // The slot of a held frame, the oldest first.
  std::int64_t slot(std::size_t place) const { return points_[place].slot; }
  double newest_residual_us() const { return points_.back().residual_us; }
  const CodeVerdict& verdict() const { return verdict_; }
  CodeCorrelator& correlator() { return correlator_; }

 private:
  struct Point {
    std::int64_t slot = 0;
    double residual_us = 0;
  };

  std::uint32_t begin_anew(std::int64_t at_ns);
  // With the next frame as the oldest.
  void give_up_oldest();
  bool is_sure() const;
  bool is_like_a_pulse(std::int64_t slots, double step_us) const;
  void correlate();

  std::shared_ptr<const CodedPulses> pulses_;
  double error_probability_;
  double least_squares_behind_ = 0;
  double least_evidence_nats_;
  double most_noise_us_;
  double most_step_us_;  // of one pulse to the next, by code and noise
  double most_rate_us_;  // a slot
  CodeCorrelator correlator_;
  std::vector<Point> points_;
  std::int64_t newest_at_ns_ = 0;
  CodeVerdict verdict_;
};

}  // namespace simbench
