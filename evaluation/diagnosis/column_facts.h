// What a recording says of its frames beside stamps (FrameColumns): exposures, the two halves of
// the delivery, the load of the link, the temperature.
//
// Where the stamp of the back end (the host's driver) is there, the delay from the sensor's stamp
// to it is that of the camera and its link, the delay from there to the arrival that of the host.
// Both are less their smallest (1 % are below), since the constant part is of two clocks.
//
//   const RecordedStream& stream = recorded.streams[0];
//   const ColumnFacts facts = column_facts(stream.columns, stream.frames, offsets_ms);
//
// Complexity: O(n).
#pragma once

#include <span>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

// Quantiles of 1, 50 and 99 % of the values that exist; NaN: none does.
struct ColumnRange {
  double low = kNan;
  double middle = kNan;
  double high = kNan;
};

struct ColumnFacts {
  ColumnRange exposure_ms;
  ColumnRange to_backend_ms;
  ColumnRange from_backend_ms;
  double bytes_per_s = kNan;  // mean, of what arrived
  double ns_per_byte = kNan;  // by which larger frames come later; NaN unless it explains half
  ColumnRange temperature_c;
};

// `offsets_ms`: arrivals less stamps, frame by frame, their drift taken out; columns and offsets
// are of these frames.
ColumnFacts column_facts(const FrameColumns& columns, std::span<const StampedFrame> frames,
                         std::span<const double> offsets_ms);

}  // namespace simbench::evaluation
