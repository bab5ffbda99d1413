// chrony's use of an estimate: how far to change the frequency, and how fast to slew the offset.
//
//  - Frequency: the measured one is trusted against the present one by their skews,
//    gain = 3 s^2 / (3 s^2 + m^2) with s the present skew and m the measured one; a measurement
//    with a skew above max_update_skew changes nothing. The skew follows by the same gain, widened
//    by how much the two disagree.
//  - Offset: all of it is corrected, by a slew. An offset as large as the estimate's own deviation
//    takes correction_ratio times the interval between updates; a larger one is corrected faster in
//    proportion, in no less than 1 s, at no more than max_slew_rate.
//
// A pure state machine. chrony steps only if it is told to (makestep), which is not here.
// Source: docs/reference/host_sync.md section 2 (chrony, conf.c); chrony.conf documentation
// (corrtimeratio, maxslewrate, maxupdateskew).
//
//   ChronyReference reference({});
//   const ChronyCorrection correction = reference.update(*stats.estimate(), now_s, left_s);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_REFERENCE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_REFERENCE_H_

#include <optional>

#include "algorithms/host_sync/chrony/chrony_source_stats.h"

namespace simbench {

struct ChronyReferenceSettings {
  double correction_ratio = 3;       // corrtimeratio
  double max_slew_rate = 83333e-6;   // as a fraction
  double max_update_skew = 1000e-6;  // as a fraction
};

struct ChronyCorrection {
  double frequency = 0;  // change of the clock's rate, as a fraction
  double offset_s = 0;   // to be added to what was still to be slewed
  double slew_rate = 0;  // for all that is left then, as a fraction; 0 if nothing is
};

class ChronyReference {
 public:
  static constexpr double kMaxFrequency = 500e-6;

  explicit ChronyReference(const ChronyReferenceSettings& settings) : settings_(settings) {}

  // `left_s` is what an unfinished slew has still to add.
  ChronyCorrection update(const ChronyEstimate& estimate, double now_s, double left_s);

  double frequency() const { return frequency_; }  // correction in all, as a fraction
  double skew() const { return skew_; }

 private:
  double change_of_frequency(const ChronyEstimate& estimate);

  ChronyReferenceSettings settings_;
  double frequency_ = 0;
  double skew_ = 1;  // nothing is known
  std::optional<double> last_update_s_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_REFERENCE_H_
