#include "app/interrupt.h"

#include <gtest/gtest.h>

#include <csignal>

namespace simbench::app {
namespace {

TEST(InterruptHandler, ASignalBetweenTwoWorksStopsTheNextOne) {
  {
    const InterruptHandler first;
    EXPECT_FALSE(InterruptHandler::raised());
    ASSERT_EQ(std::raise(SIGINT), 0);
  }
  const InterruptHandler second;
  EXPECT_TRUE(InterruptHandler::raised());
  EXPECT_FALSE(InterruptHandler::insisted());
  InterruptHandler::set(false);
}

TEST(InterruptHandler, TheEndOfAJobIsOneToo) {
  const InterruptHandler handler;
  ASSERT_EQ(std::raise(SIGTERM), 0);
  EXPECT_TRUE(InterruptHandler::raised());
  InterruptHandler::set(false);
}

}  // namespace
}  // namespace simbench::app
