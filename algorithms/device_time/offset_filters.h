// device_time by filters of the offset arrival - sensor, each with a memory of its own.
//
// They share the series of samples (offset_stream.h): the first frame, and the first after a clock
// was set or restarted, is stamped with its arrival; a frame not later than the newest is stamped
// and not used.
// Source, if none is named: docs/reference/device_time.md section 1.
//
//   auto estimator = make_sliding_minimum({.window_s = 1});
//   GlobalTime stamp = estimator->stamp(sample);
#pragma once

#include <cstddef>
#include <memory>

#include "algorithms/device_time/device_time.h"
#include "algorithms/parameter_binder.h"

namespace simbench {

// Olson's passive synchronisation: the offset grows by alpha a second, and falls at once to that of
// a frame that was delayed less.
//
//   est = q + (s - p) * (1 + alpha);  if est >= h: (p, q) = (s, h), est = h
//
// alpha must exceed the skew, or the estimate cannot follow; the excess leaks into the stamps. Two
// numbers of state, O(1). The estimate follows a downward step of the host at once, an upward one
// at alpha.
//
// Source: Olson, A Passive Solution to the Sensor Synchronization Problem, IROS 2010.
struct OlsonSettings {
  double alpha_ppm = 50;

  void bind(ParameterBinder& parameters);
};

std::unique_ptr<DeviceTimeEstimator> make_olson(OlsonSettings settings);

// The sliding minimum: sensor stamp plus the least offset of the last W seconds of sensor time. The
// best of the simple methods.
//
// A skew of r leaves an error of up to r * W. The estimate follows a downward step of the host at
// once, an upward one after W.
//
// Complexity: amortised O(1) with a queue of increasing offsets. It holds at most kMaxQueued; if
// offsets keep increasing for longer than that within W, the newest replaces the one before, which
// can only matter W later, by the difference of two frames.
struct SlidingMinimumSettings {
  double window_s = 1;  // positive
};

std::unique_ptr<DeviceTimeEstimator> make_sliding_minimum(SlidingMinimumSettings settings);

// Theil-Sen regression over the last n frames: the slope is the median of the slopes of all pairs,
// the level the median of the residuals.
//
// Robust against outliers; with one-sided delay its bias is about the median instead of the mean.
// A refit takes O(n^2), 45,000 slopes for 300 frames, so there is one every n/20 frames (each
// frame, while the window holds fewer than 40); in between frames are stamped from the last line.
// Memory: n frames and n^2/2 slopes.
//
// Source: Sen 1968; docs/reference/device_time.md section 1 (there too a refit every 15 of 300
// frames).
struct TheilSenWindow {
  std::size_t frames = 300;  // 1 to 10,000
};

std::unique_ptr<DeviceTimeEstimator> make_theil_sen(TheilSenWindow window);

// A Kalman filter of offset and skew, after KalmanOwt of cuckoo_time_translator.
//
//   x = [offset, skew],  F = [1 dt; 0 1],  Q = diag(0, skew_sigma^2) dt,  R = offset_sigma^2
//
// A frame whose residual exceeds `gate` standard deviations of the innovation is rejected. After a
// bad start such a gate rejects for ever: with a first frame 24 ms late all others are rejected,
// and as Q adds nothing to the offset the filter cannot recover (measured: 124 to 480 ms off for
// good). After `rejections_to_restart` in a row it therefore begins anew from the present frame.
//
// Delay is one-sided, so its mean within the gate stays in the stamps as a bias (0.28 ms for
// Exp(0.3 ms)). The defaults are the reference page's "tuned" row, not cuckoo's, whose cooldown and
// wide sigmas do worse on frames. O(1).
struct KalmanSettings {
  double initial_offset_sigma_ms = 2;
  double initial_skew_sigma_ppm = 1000;
  double offset_sigma_ms = 0.3;  // of one arrival
  double skew_sigma_ppm = 2;     // random walk of the skew, per square root of a second
  double gate = 3;               // in standard deviations
  int rejections_to_restart = 10;

  void bind(ParameterBinder& parameters);
};

std::unique_ptr<DeviceTimeEstimator> make_kalman(KalmanSettings settings);

}  // namespace simbench
