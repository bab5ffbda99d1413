// Where a camera's phase is and was, from stretch to stretch: whether it has moved, and how.
//
//   PhaseTrack track;
//   if (const auto moved = track.add(phase_ms, common_ms, period_ms)) print(moved->by_ms);
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "evaluation/statistics/statistics.h"

namespace simbench::watch {

inline constexpr double kMovedShare = 0.05;  // of a period, as the steps of stamp_grid.h
inline constexpr double kMovedSigmas = 6;    // of the phase's own scatter

// The median absolute distance of normal noise times this is its standard deviation.
inline constexpr double kSigmaOfMad = 1.4826;

struct PhaseMove {
  double by_ms = 0;
  bool is_slip = false;  // from one stretch to the next; else little by little
};

class PhaseTrack {
 public:
  // How far the phase lies from where it was; NaN before that is known.
  double change_ms(double phase_ms, double period_ms) const;
  // The next stretch, of whose change all cameras share `common_ms`. A move counts once two
  // stretches agree on it; from then on the phase is where it is now.
  std::optional<PhaseMove> add(double phase_ms, double common_ms, double period_ms);
  // The reference camera is another one, at this place of the old one's.
  void shift(double reference_ms, double period_ms);

  double phase_ms() const { return last_ms_; }
  double moved_ms() const { return moved_ms_; }  // since it was first known
  double scatter_ms() const;
  double limit_ms(double period_ms) const;
  bool is_known() const { return stretches_ >= kLearned; }

 private:
  static constexpr std::size_t kLearned = 4;  // stretches
  static constexpr std::size_t kKept = 32;

  std::size_t stretches_ = 0;
  double place_ms_ = evaluation::kNan;  // where it was
  double last_ms_ = evaluation::kNan;
  double moved_ms_ = 0;
  std::deque<double> steps_ms_;           // from stretch to stretch
  std::optional<double> suspected_ms_{};  // the move that the last stretch showed
  double before_ms_ = 0;                  // and what it was off before that
};

}  // namespace simbench::watch
