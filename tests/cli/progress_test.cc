#include "cli/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace simbench::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

// A clock that the test moves, and what the progress wrote.
struct Bench {
  explicit Bench(ProgressStyle style)
      : progress(out, style, "run", [this] { return std::chrono::duration<double>(now); }) {}

  std::string new_text() {
    std::string text = out.str();
    out.str("");
    return text;
  }

  double now = 0;
  std::ostringstream out;
  Progress progress;
};

TEST(Progress, ALogGetsALineAtEveryQuarter) {
  Bench bench({.terminal = false});
  for (std::uint64_t done = 0; done <= 8; ++done) {
    bench.now = static_cast<double>(done);
    bench.progress.update(done, 8);
  }
  bench.progress.finish();
  EXPECT_EQ(bench.new_text(),
            "0 of 8 runs (0 %)\n"
            "2 of 8 runs (25 %), 6 s left\n"
            "4 of 8 runs (50 %), 4 s left\n"
            "6 of 8 runs (75 %), 2 s left\n"
            "8 runs in 8 s\n");
}

TEST(Progress, ATerminalGetsOneLineThatIsErased) {
  Bench bench({.terminal = true, .colour = false, .width = 60});
  bench.now = 30;
  bench.progress.update(1, 4);
  EXPECT_EQ(bench.new_text(),
            "\r\x1b[K[######..................]  25 % of 4 runs, 1 min 30 s left");
  bench.progress.finish();
  EXPECT_EQ(bench.new_text(), "\r\x1b[K");
  bench.progress.update(2, 4);
  EXPECT_EQ(bench.new_text(), "");
}

TEST(Progress, IsRedrawnTenTimesASecondAtMost) {
  Bench bench({.terminal = true, .colour = false, .width = 60});
  bench.progress.update(1, 1000);
  EXPECT_NE(bench.new_text(), "");
  bench.now = 0.05;
  bench.progress.update(2, 1000);
  EXPECT_EQ(bench.new_text(), "");
  bench.now = 0.11;
  bench.progress.update(3, 1000);
  EXPECT_NE(bench.new_text(), "");
}

TEST(Progress, FitsNarrowTerminals) {
  for (int width = 1; width < 100; ++width) {
    Bench bench({.terminal = true, .colour = false, .width = width});
    bench.now = 1e6;
    bench.progress.update(1, 1'000'000);
    const std::string line = bench.new_text().substr(4);
    EXPECT_LT(static_cast<int>(line.size()), std::max(width, 1)) << line;
  }
}

TEST(Progress, ColourOnlyWhereItIsWanted) {
  Bench plain({.terminal = true, .colour = false, .width = 80});
  plain.progress.update(1, 2);
  EXPECT_THAT(plain.new_text(), Not(HasSubstr("\x1b[3")));
  Bench coloured({.terminal = true, .colour = true, .width = 80});
  coloured.progress.update(1, 2);
  EXPECT_THAT(coloured.new_text(), HasSubstr("\x1b[32m"));
}

TEST(Progress, JsonLinesTenASecondAtMost) {
  Bench bench({.json = true});
  EXPECT_EQ(bench.new_text(), "{\"event\":\"start\",\"unit\":\"runs\"}\n");
  bench.progress.update(0, 400);
  EXPECT_EQ(bench.new_text(),
            "{\"event\":\"progress\",\"done\":0,\"total\":400,\"unit\":\"runs\","
            "\"elapsed_s\":0.0,\"eta_s\":null}\n");
  for (std::uint64_t done = 1; done <= 100; ++done) {
    bench.now = static_cast<double>(done) / 100;
    bench.progress.update(done, 400);
  }
  const std::string second = bench.new_text();
  const auto lines = std::count(second.begin(), second.end(), '\n');
  EXPECT_GE(lines, 7);
  EXPECT_LE(lines, 8);
  EXPECT_THAT(second, HasSubstr("\"elapsed_s\":0.13,\"eta_s\":3.87}"));
  bench.progress.finish();
  EXPECT_EQ(bench.new_text(),
            "{\"event\":\"end\",\"done\":100,\"total\":400,\"unit\":\"runs\","
            "\"elapsed_s\":1.0}\n");
  bench.progress.interrupt();
  EXPECT_EQ(bench.new_text(), "");
}

TEST(Progress, NothingToDoIsNoProgress) {
  Bench bench({.terminal = false});
  bench.progress.update(0, 0);
  EXPECT_EQ(bench.new_text(), "");
}

}  // namespace
}  // namespace simbench::cli
