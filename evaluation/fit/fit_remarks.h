// What a stream has and its model does not, in words: frames that are later than a frame period,
// periods without a frame, a rate that varies, one clock where two are needed.
//
//   for (const std::string& line : stream_remarks(stream, fit)) print(line);
#pragma once

#include <string>
#include <vector>

#include "evaluation/fit/fit.h"
#include "evaluation/fit/fit_input.h"

namespace simbench::evaluation {

// A line each, without the stream's name; `fit` is that of the stream. O(n log n).
std::vector<std::string> stream_remarks(const FitStream& stream, const StreamFit& fit);

}  // namespace simbench::evaluation
