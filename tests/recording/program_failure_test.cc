#include "recording/program_failure.h"

#include <gmock/gmock.h>

#include <vector>

namespace simbench {
namespace {

using testing::ElementsAre;

ProgramFailure failure(PeerId host, std::int64_t at_ns, const std::string& last_words = "") {
  return {.host = host,
          .program = "chronyd",
          .at = Nanoseconds(at_ns),
          .how = "exited with status 1",
          .last_words = last_words};
}

TEST(ProgramFailure, TimesAreToTheMicrosecond) {
  EXPECT_EQ(run_time_text(Nanoseconds(0)), "0.000000 s");
  EXPECT_EQ(run_time_text(Nanoseconds(8'320)), "0.000008 s");
  EXPECT_EQ(run_time_text(Nanoseconds(3'600'000'000'999)), "3600.000000 s");
}

TEST(ProgramFailure, ALineHasHostTimeProgramAndReason) {
  EXPECT_EQ(failure_text(failure(3, 250'000'000)),
            "host 3, at 0.250000 s: chronyd: exited with status 1");
  EXPECT_EQ(failure_text(failure(3, 250'000'000, "No such file")),
            "host 3, at 0.250000 s: chronyd: exited with status 1: No such file");
}

TEST(ProgramFailure, HostsThatFailAlikeAreOneLine) {
  const std::vector<ProgramFailure> failures = {failure(4, 3000), failure(2, 2000, "else"),
                                                failure(1, 1000)};
  EXPECT_THAT(failure_lines(failures),
              ElementsAre("hosts 1, 4, first at 0.000001 s: chronyd: exited with status 1",
                          "host 2, at 0.000002 s: chronyd: exited with status 1: else"));
  EXPECT_THAT(failure_lines({}), testing::IsEmpty());
}

}  // namespace
}  // namespace simbench
