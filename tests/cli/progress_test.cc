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
  explicit Bench(ProgressStyle style, const std::string& unit = "run")
      : progress(out, style, unit, [this] { return std::chrono::duration<double>(now); }) {}

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

TEST(Progress, BytesHaveTheUnitOfTheWhole) {
  const auto text = [](std::uint64_t done, std::uint64_t total) {
    Bench bench({.terminal = false}, "byte");
    bench.progress.update(done, total);
    return bench.new_text();
  };
  EXPECT_EQ(text(0, 999), "0 of 999 bytes (0 %)\n");
  EXPECT_EQ(text(0, 1), "0 of 1 byte (0 %)\n");
  EXPECT_THAT(text(1'000, 141'000), HasSubstr("1.00 of 141.00 kB (0 %)"));
  EXPECT_THAT(text(1'650'340, 3'708'268), HasSubstr("1.65 of 3.71 MB (44 %)"));
  EXPECT_THAT(text(30'000'000'000, 40'000'000'000), HasSubstr("30.00 of 40.00 GB (75 %)"));
  EXPECT_THAT(text(3'708'268, 3'708'268), HasSubstr("3.71 MB in "));
  Bench bar({.terminal = true, .colour = false, .width = 60}, "byte");
  bar.progress.update(1'650'340, 3'708'268);
  EXPECT_THAT(bar.new_text(), HasSubstr(" 44 % of 3.71 MB"));
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

TEST(Progress, ALogGetsOneEstimateOfRunsUnderWay) {
  Bench bench({.terminal = false});
  bench.progress.update({.done = 0.01, .total = 2, .left_s = evaluation::kNan});
  EXPECT_EQ(bench.new_text(), "") << "nothing is known";
  bench.progress.update({.done = 0.05, .total = 2, .left_s = 1});
  EXPECT_EQ(bench.new_text(), "") << "a moment";
  bench.progress.update({.done = 0.06, .total = 2, .left_s = 40.2});
  EXPECT_EQ(bench.new_text(), "about 41 s left, by the speed of the first 3 %\n");
  bench.progress.update({.done = 0.08, .total = 2, .left_s = 39});
  EXPECT_EQ(bench.new_text(), "") << "once";
  bench.now = 20;
  bench.progress.update(1, 2);
  EXPECT_EQ(bench.new_text(), "1 of 2 runs (50 %), 39 s left\n") << "as measured, not 20 s";
}

TEST(Progress, ABarMovesWithinRuns) {
  Bench bench({.terminal = true, .colour = false, .width = 60});
  bench.now = 5;
  bench.progress.update({.done = 0.5, .total = 1, .left_s = 5});
  EXPECT_THAT(bench.new_text(), HasSubstr("  50 % of 1 run, 5 s left"));
  bench.progress.update({.done = 0.6, .total = 1, .left_s = 4});
  EXPECT_EQ(bench.new_text(), "") << "ten times a second at most";
}

TEST(Progress, JsonHasTheEstimateBeforeTheFirstRunIsDone) {
  Bench bench({.json = true});
  bench.new_text();
  bench.now = 1;
  bench.progress.update({.done = 0.1, .total = 2, .left_s = evaluation::kNan});
  EXPECT_EQ(bench.new_text(), "");
  bench.progress.update({.done = 0.2, .total = 2, .left_s = 9});
  EXPECT_EQ(bench.new_text(),
            "{\"event\":\"progress\",\"done\":0,\"total\":2,\"unit\":\"runs\","
            "\"elapsed_s\":1.0,\"eta_s\":9.0}\n");
}

TEST(Progress, NothingToDoIsNoProgress) {
  Bench bench({.terminal = false});
  bench.progress.update(0, 0);
  EXPECT_EQ(bench.new_text(), "");
}

}  // namespace
}  // namespace simbench::cli
