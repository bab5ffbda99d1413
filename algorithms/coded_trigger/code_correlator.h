// Which place of a trigger's code some frames stand at: the likelihood of every place at once.
//
// A point is a frame: its slot, counted in pulses from the first point, and its residual, the time
// since the first point less slot * period. If the first point is the code's place p, then
//
//   residual = level + rate * slot + shift(p + slot) + noise
//
// with any level, a rate from N(0, rate_error) and normal noise. The least squares of level and
// rate leave the sum of squares RSS(p), and the likelihood of p is exp(-RSS(p) / (2 noise^2)). All
// of it comes from sums over the points that are kept for each place, so that a point costs one
// pass over the code, and no point is kept.
//
// Where a code leaves pulses out, a frame in a left-out place costs kImpossible nats, and a place
// without a frame whose pulse was sent -ln(lost_share).
//
// The places are equally probable beforehand, so that the share of all others in the sum of the
// likelihoods is the probability that the best place is wrong. It holds if the noise is normal and
// no larger than stated; if the best place leaves more noise than that, this larger noise counts.
//
// Complexity: a point O(length), a verdict O(length). Memory: 48 bytes a pulse of the code.
// Source: docs/coded_trigger.md section 4.
//
//   CodeCorrelator correlator(code, {.noise_us = 5});
//   correlator.add(0, 0);
//   correlator.add(1, -101.2);
//   const CodeVerdict verdict = correlator.judge();
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "laws/trigger_code.h"

namespace simbench {

struct CodeNoise {
  double noise_us = 5;          // of a stamp against its pulse, standard deviation
  double rate_error_ppm = 100;  // of the camera's clock against the trigger's, likewise
  double lost_share = 0.02;     // of frames, in codes that leave pulses out
};

struct CodeVerdict {
  std::size_t place = 0;         // of slot 0
  double error_probability = 1;  // that it is another
  double squares_behind = 0;     // RSS of the one that leaves least after it, less its own
  double noise_us = 0;           // what this place leaves, at least as much as stated
  double level_us = 0;
  double rate_us = 0;  // a slot
};

class CodeCorrelator {
 public:
  static constexpr double kImpossible = 25;  // nats: never, but for what nobody thought of

  // `code` must outlive this.
  CodeCorrelator(const TriggerCode& code, const CodeNoise& noise);

  std::size_t points() const { return points_; }
  std::size_t places() const { return costs_.size(); }
  void clear();
  // Slots do not fall.
  void add(std::int64_t slot, double residual_us) { count(slot, residual_us, 1); }
  // No frame came in this slot; it matters only where a code leaves pulses out.
  void add_absent(std::int64_t slot) { count_absent(slot, 1); }
  // Takes out what was added.
  void remove(std::int64_t slot, double residual_us) { count(slot, residual_us, -1); }
  void remove_absent(std::int64_t slot) { count_absent(slot, -1); }
  // At least 3 points.
  CodeVerdict judge();
  // By how much a place is less likely than that of the verdict on the same points, if the noise is
  // as large as that.
  double nats_behind(const CodeVerdict& verdict, std::size_t place, double noise_us) const;

 private:
  // `sign`: 1 or -1.
  void count(std::int64_t slot, double residual_us, int sign);
  void count_absent(std::int64_t slot, int sign);
  template <class Add>
  void at_each_place(std::int64_t slot, const Add& add);
  double squares_at(std::size_t place) const;

  const TriggerCode& code_;
  CodeNoise noise_;
  double even_square_ = 0;  // of every shift, if all have the same size, else negative
  double loss_nats_ = 0;
  std::size_t points_ = 0;
  double sum_t_ = 0;
  double sum_tt_ = 0;
  double sum_y_ = 0;
  double sum_ty_ = 0;
  double sum_yy_ = 0;
  double prior_ = 0;  // what the prior of the rate adds to sum_tt_
  std::vector<double> shifts_us_;
  // Over the points, by place of slot 0: sums of shift, slot * shift, residual * shift, shift^2.
  std::vector<double> sum_s_;
  std::vector<double> sum_ts_;
  std::vector<double> sum_ys_;
  std::vector<double> sum_ss_;  // empty if all shifts have the same size
  std::vector<double> nats_;    // of frames and losses; empty if no pulse is left out
  std::vector<double> costs_;   // of one verdict
};

}  // namespace simbench
