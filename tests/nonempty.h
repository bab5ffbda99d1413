// A range whose elements a test checks one by one: without any, the loop would pass and check
// nothing, so an empty range fails the test.
//
//   for (const auto& frame : nonempty(capture(scenario).frames)) EXPECT_GT(frame.counter, 0u);
#pragma once

#include <gtest/gtest.h>

#include <iterator>
#include <utility>

namespace simbench {

// A named range is passed on; a temporary one is given back by value, so that it outlives the loop.
// The failure names the caller's line (clang 14 has no std::source_location).
template <typename Range>
Range nonempty(Range&& range, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  using std::begin;  // found beside those of the range's own namespace
  using std::end;
  if (begin(range) == end(range)) {
    ADD_FAILURE_AT(file, line) << "nothing to check: empty range";
  }
  return std::forward<Range>(range);
}

}  // namespace simbench
