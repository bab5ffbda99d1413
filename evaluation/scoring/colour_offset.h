// How far the colour frames of a rig are from its depth frames, by the true mid-exposures.
//
// Modes that trigger depth alone (GenLock, Slave) leave colour to expose anywhere in its period;
// Full Slave triggers both. AMD and RMDV look at one stream and cannot show it.
//
//   offset   of a camera at an evaluated pulse: the mid-exposure of its colour frame less that of
//            its depth frame of the pulse. The colour frame is the nearest in time: only modes that
//            trigger both streams say which belongs to the pulse
//   mean     of the offsets' absolute values, over pulses and cameras
//   spread   the range of the offsets over all cameras, its mean over the pulses at which every
//            camera has one
//
// A depth frame has an offset if it lies between two colour frames of its camera that follow each
// other by the camera's counter: beside a lost frame the nearest is unknown. All is NaN without
// colour, depth or truth, the spread also of a single camera. What to expect where colour runs free
// with period T: a mean of T/4 over many rigs, a spread of T (n - 1)/(n + 1) over n cameras.
//
// Memory: 16 bytes for each colour frame and each evaluated depth frame. Complexity: O(n log n) of
// n frames. Source: Yoon et al. 2021, section 4.3 and figures 11 to 13; docs/design.md section 8.
//
//   RigLayout layout;              // of the capture
//   ColourOffset offsets(layout);
//   offsets.add(frame, truth);     // each frame of both streams
//   offsets.add_to(seed_score);
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "recording/recording.h"

namespace simbench::evaluation {

class ColourOffset {
 public:
  explicit ColourOffset(const RigLayout& layout);

  // A frame of a camera of the layout, in any order.
  void add(const FrameRecord& frame, const FrameTruth& truth);

  // Sets colour_offset_ms and colour_offset_spread_ms.
  void add_to(MetricValues<double>& score);

 private:
  struct Depth {
    std::int64_t mid_ns = 0;  // true mid-exposure
    std::int64_t pulse = 0;
  };
  struct Colour {
    std::int64_t mid_ns = 0;
    std::uint32_t counter = 0;
  };
  struct Camera {
    std::vector<Depth> depth;
    std::vector<Colour> colour;
  };

  std::int64_t first_pulse_;
  std::int64_t pulses_;
  std::vector<Camera> cameras_;
};

}  // namespace simbench::evaluation
