#include <gmock/gmock.h>

#include <filesystem>
#include <random>
#include <string>

#include "reports/sweep/sweep_folder.h"
#include "reports/text/output_file.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRuns = 20;
constexpr const char* kIdentity = "this sweep";

class SweepLogTest : public testing::Test {
 protected:
  fs::path path() const { return folder_ / "runs.log"; }
  std::string content() const { return folder_.content("runs.log"); }
  void set_content(const std::string& text) const { folder_.write("runs.log", text); }
  // Runs 0 to kRuns - 1, the last one first.
  void write_all_runs() const {
    SweepLog log(path(), kIdentity, kRuns);
    for (std::size_t run = kRuns; run-- > 0;) log.append(run, text_of(run));
  }
  static std::string text_of(std::size_t run) { return std::to_string(run) + ".5,x;1,2"; }

 private:
  const ScratchFolder folder_;
};

TEST_F(SweepLogTest, KeepsWhatWasAppended) {
  {
    SweepLog log(path(), kIdentity, kRuns);
    EXPECT_EQ(log.finished(), 0U);
    log.append(7, "seven");
    log.append(3, "three");
  }
  const SweepLog log(path(), kIdentity, kRuns);
  EXPECT_EQ(log.finished(), 2U);
  EXPECT_EQ(log.damaged(), 0U);
  EXPECT_EQ(log.text(7), "seven");
  EXPECT_EQ(log.text(3), "three");
  EXPECT_EQ(log.text(4), "");
}

// A record is one line, there as soon as append() returns.
TEST_F(SweepLogTest, NothingWaitsInMemory) {
  SweepLog log(path(), kIdentity, kRuns);
  log.append(1, "one");
  EXPECT_THAT(content(), testing::MatchesRegex("1 [0-9a-f]+ one\n"));
}

// Killed anywhere: whatever was written whole counts, and no more than one record is damaged.
TEST_F(SweepLogTest, CutOffAnywhere) {
  write_all_runs();
  const std::string whole = content();
  for (std::size_t size = 0; size < whole.size(); size += 3) {
    set_content(whole.substr(0, size));
    const auto lines = static_cast<std::size_t>(
        std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size), '\n'));
    SweepLog log(path(), kIdentity, kRuns);
    EXPECT_EQ(log.finished(), lines) << size;
    EXPECT_LE(log.damaged(), 1U) << size;
    for (std::size_t run = 0; run < kRuns; ++run) {
      if (log.text(run).empty()) log.append(run, text_of(run));
    }
    log.put_in_order();
    const SweepLog again(path(), kIdentity, kRuns);
    EXPECT_EQ(again.finished(), kRuns);
    EXPECT_EQ(again.damaged(), 0U);
  }
}

TEST_F(SweepLogTest, EveryChangedBitIsNoticed) {
  write_all_runs();
  const std::string whole = content();
  std::mt19937 random(5);
  for (int round = 0; round < 400; ++round) {
    std::string changed = whole;
    const std::size_t at = random() % whole.size();
    changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
    set_content(changed);
    const SweepLog log(path(), kIdentity, kRuns);
    EXPECT_GE(log.damaged(), 1U) << at;
    EXPECT_LT(log.finished(), kRuns) << at;
    for (std::size_t run = 0; run < kRuns; ++run) {
      if (!log.text(run).empty()) {
        EXPECT_EQ(log.text(run), text_of(run)) << at;
      }
    }
  }
}

TEST_F(SweepLogTest, DamageIsSaidOnce) {
  write_all_runs();
  set_content(content() + "12 0000");
  EXPECT_EQ(SweepLog(path(), kIdentity, kRuns).damaged(), 1U);
  EXPECT_EQ(SweepLog(path(), kIdentity, kRuns).damaged(), 0U);
}

TEST_F(SweepLogTest, AnotherSweepsRecordsDoNotCount) {
  write_all_runs();
  const SweepLog log(path(), "another sweep", kRuns);
  EXPECT_EQ(log.finished(), 0U);
  EXPECT_EQ(log.damaged(), kRuns);
}

TEST_F(SweepLogTest, ARunBeyondThePlanDoesNotCount) {
  write_all_runs();
  const SweepLog log(path(), kIdentity, 5);
  EXPECT_EQ(log.finished(), 5U);
  EXPECT_EQ(log.damaged(), kRuns - 5);
}

TEST_F(SweepLogTest, InOrderTheBytesAreTheSame) {
  write_all_runs();
  {
    SweepLog log(path(), kIdentity, kRuns);
    log.put_in_order();
  }
  const std::string backwards = content();
  fs::remove(path());
  {
    SweepLog log(path(), kIdentity, kRuns);
    for (std::size_t run = 0; run < kRuns; ++run) log.append(run, text_of(run));
  }
  EXPECT_EQ(content(), backwards);
}

TEST_F(SweepLogTest, AppendsAfterPuttingInOrder) {
  {
    SweepLog log(path(), kIdentity, kRuns);
    log.append(2, "two");
    log.append(1, "one");
    log.put_in_order();
    log.append(3, "three");
  }
  const SweepLog log(path(), kIdentity, kRuns);
  EXPECT_EQ(log.finished(), 3U);
  EXPECT_EQ(log.damaged(), 0U);
}

TEST_F(SweepLogTest, CannotBeWritten) {
  try {
    SweepLog log(path() / "nowhere", kIdentity, kRuns);
    FAIL() << "nothing was thrown";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("cannot be written"));
  }
}

}  // namespace
}  // namespace simbench::reports
