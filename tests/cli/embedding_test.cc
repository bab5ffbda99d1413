#include "cli/embedding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli/messages.h"
#include "cli/process.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"
#include "tests/scratch_folder.h"

namespace simbench::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::internal::CaptureStderr;
using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStderr;
using testing::internal::GetCapturedStdout;

TEST(Embedding, KeepsWhatACommandWrites) {
  CaptureStdout();
  CaptureStderr();
  Embedding within;
  EXPECT_EQ(run_embedded({"simbench", "list", "studies", "--format", "names"}, within), kOk);
  EXPECT_EQ(GetCapturedStdout(), "");
  EXPECT_EQ(GetCapturedStderr(), "");
  EXPECT_THAT(within.output.str(), HasSubstr("scalability\n"));
  EXPECT_TRUE(within.messages.empty());
  EXPECT_EQ(embedding(), nullptr);
}

TEST(Embedding, GivesAllWantedFormatsOfOneWork) {
  Embedding within;
  within.formats = {"json", "table", "html"};
  std::uint64_t reported = 0;
  within.progress = [&reported](std::uint64_t, std::uint64_t) { ++reported; };
  EXPECT_EQ(run_embedded({"simbench", "advise", "--require", "amd<50ms", "--cameras", "3",
                          "--hosts", "1", "--seeds", "2"},
                         within),
            kOk);
  const auto json = nlohmann::json::parse(within.results["json"]);
  const std::string rig = json["options"][0]["rig"];
  EXPECT_THAT(within.results["table"], HasSubstr(rig));
  EXPECT_THAT(within.results["html"], HasSubstr("<th scope=\"row\" class=\"text\">office_pc</th>"));
  EXPECT_EQ(within.results.size(), 3U);
  EXPECT_EQ(within.output.str(), "");
  EXPECT_GT(reported, 0U);
}

TEST(Embedding, ThrowsWhatIsRefused) {
  Embedding within;
  EXPECT_THROW(run_embedded({"simbench", "run", "--scenario", "none"}, within),
               scenarios::InputError);
  try {
    run_embedded({"simbench", "run", "--scenario", "3cam_1host_30fps", "--seeds", "0"}, within);
    ADD_FAILURE() << "was not refused";
  } catch (const scenarios::InputError& error) {
    EXPECT_STREQ(error.what(), "--seeds: found '0', allowed: a whole number from 1 to 1000000");
  }
  EXPECT_TRUE(within.messages.empty());
  EXPECT_EQ(embedding(), nullptr) << "also after an exception";
}

TEST(Embedding, KeepsMessagesInOrder) {
  Embedding within;
  const ScratchFolder scratch;
  const std::string file = scratch.write("wrong.json", "{");
  EXPECT_EQ(run_embedded({"simbench", "validate", file, file}, within), kBadInput);
  std::vector<std::string> kinds;
  for (const EmbeddedMessage& message : within.messages) kinds.push_back(message.kind);
  EXPECT_THAT(kinds, ElementsAre("error", "error"));
}

TEST(Embedding, TheProcessStaysItsOwners) {
  struct sigaction before = {};
  ASSERT_EQ(sigaction(SIGINT, nullptr, &before), 0);
  reports::set_page_width(77);
  Embedding within;
  within.columns = 40;
  struct sigaction during = {};
  within.progress = [&during](std::uint64_t, std::uint64_t) {
    sigaction(SIGINT, nullptr, &during);
  };
  EXPECT_EQ(run_embedded({"simbench", "advise", "--require", "amd<50ms", "--cameras", "3",
                          "--hosts", "1", "--seeds", "2"},
                         within),
            kOk);
  EXPECT_EQ(during.sa_handler, before.sa_handler);
  EXPECT_EQ(reports::page_width(), 77U);
  reports::set_page_width(std::nullopt);

  const EmbeddingScope scope(within);
  EXPECT_EQ(become_sibling("simbench", {"simbench", "--version"}), ENOTSUP);
}

}  // namespace
}  // namespace simbench::cli
