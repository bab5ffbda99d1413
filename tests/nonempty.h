// A range whose elements a test checks one by one: without any, the loop would pass and check
// nothing, so an empty range fails the test.
//
//   for (const auto& frame : nonempty(capture(scenario).frames)) EXPECT_GT(frame.counter, 0u);
#ifndef SIMBENCH_TESTS_NONEMPTY_H_
#define SIMBENCH_TESTS_NONEMPTY_H_

#include <gtest/gtest.h>

#include <ranges>
#include <source_location>
#include <utility>

namespace simbench {

// A named range is passed on; a temporary one is given back by value, so that it outlives the loop.
template <typename Range>
Range nonempty(Range&& range, std::source_location at = std::source_location::current()) {
  if (std::ranges::begin(range) == std::ranges::end(range)) {
    ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << "nothing to check: empty range";
  }
  return std::forward<Range>(range);
}

}  // namespace simbench

#endif  // SIMBENCH_TESTS_NONEMPTY_H_
