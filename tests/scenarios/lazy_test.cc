#include "scenarios/lazy.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace simbench::scenarios {
namespace {

TEST(Lazy, IsMadeOnceAndOnlyWhenAskedFor) {
  int made = 0;
  const Lazy<std::string> text([&made] { return std::to_string(++made); });
  const Lazy<std::string> copy = text;
  EXPECT_EQ(made, 0);
  EXPECT_EQ(copy(), "1");
  EXPECT_EQ(text(), "1");
  EXPECT_EQ(&copy(), &text());
}

TEST(Lazy, StatedValue) {
  EXPECT_EQ(Lazy<std::string>()(), "");
  EXPECT_EQ(Lazy<std::string>("stated")(), "stated");
}

TEST(Lazy, AFailureIsTriedAgain) {
  int asked = 0;
  const Lazy<std::string> text([&asked]() -> std::string {
    if (++asked == 1) throw std::runtime_error("not yet");
    return "now";
  });
  EXPECT_THROW(text(), std::runtime_error);
  EXPECT_EQ(text(), "now");
}

TEST(Lazy, ThreadsAskAtOnce) {
  int made = 0;
  const Lazy<std::string> text([&made] { return std::to_string(++made); });
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back([text] { EXPECT_EQ(text(), "1"); });
  threads.clear();
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace simbench::scenarios
