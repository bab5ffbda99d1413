// Delays of a frame between the end of its transfer and the application: copy to the kernel, jitter
// of the delivery, jitter that all cameras of a host share, and rare big jumps.
//
//   delivery = end of transfer + kernel copy + own jitter + host's jitter + jump
//
// Where the scenario has a table of measured delays (usb/delivery_quantiles_ms), it takes the place
// of kernel copy, own jitter and jump, and the copy takes no time:
//
//   delivery = end of transfer + table(Phi(z[i])) + host's jitter
//   z[i] = r * z[i-1] + sqrt(1 - r^2) * N(1),   r = usb/delivery_correlation
//
// so that each delay has the table's distribution and a Gaussian copula joins successive ones, with
// the rank correlation (Spearman's) 6 / pi * asin(r / 2).
//
// All other terms scale with the transfer time of one frame alone on the bus
// (docs/reference/calibration.md); frames of one stream never overtake each other.
//
// The host's part is an AR(1) process on a grid of frame periods in true time,
// h[i] = rho * h[i-1] + (1 - rho) * Exp(mean), so it does not depend on the frames.
//
// Source: docs/reference/calibration.md section 2 ("Cameras"), parameters jcam, jhost, jrho, spk,
// spkm. Copula: Nelsen, "An Introduction to Copulas", 2006, sections 2.3 and 5.1.
#pragma once

#include <cstdint>

#include "laws/quantile_table.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

// The part of the jitter that is common to the cameras of one host.
class HostJitter {
 public:
  HostJitter(const scenarios::Usb& settings, std::uint64_t seed, std::size_t host,
             TrueTime capture_start, double period_ns);
  // In transfer times. `t` may not go back by more than the present grid cell.
  double at(TrueTime t);

 private:
  double mean_;
  double correlation_;
  double period_ns_;
  TrueTime start_;
  std::int64_t cell_ = -1;
  double value_ = 0;
  RandomStream stream_;
};

// One stream's own delays. Draws are made for every exposed frame, in order of exposure.
class FrameDelays {
 public:
  // `settings` outlives this.
  FrameDelays(const scenarios::Usb& settings, std::uint64_t seed, std::size_t stream);

  struct Draw {
    double kernel_copy_ns;
    double delivery_ns;  // own jitter and jumps, or the table's delay
  };
  Draw draw(double transfer_ns);

 private:
  double draw_from_table_ms();

  double kernel_copy_mean_ns_;
  double jitter_transfers_;
  double spike_probability_;
  double spike_max_transfers_;
  QuantileTable table_ms_;
  double correlation_;
  double innovation_;  // sqrt(1 - correlation^2)
  double variate_ = 0;
  bool has_variate_ = false;  // the first one has no predecessor
  RandomStream stream_;
  KeyedStreams frames_;  // in its place under a seed field
  std::uint64_t frame_ = 0;
};

}  // namespace simbench::sim
