#include "laws/generators.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/first_draws.h"

namespace simbench {
namespace {

using testing::ElementsAre;

TEST(SplitMix64, GivesThePublishedValues) {
  EXPECT_THAT(first_draws(SplitMix64(1234567), 5),
              ElementsAre(6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                          4593380528125082431U, 16408922859458223821U));
}

TEST(Xoshiro256PlusPlus, GivesThePublishedValues) {
  EXPECT_THAT(first_draws(Xoshiro256PlusPlus({1, 2, 3, 4}), 10),
              ElementsAre(41943041U, 58720359U, 3588806011781223U, 3591011842654386U,
                          9228616714210784205U, 9973669472204895162U, 14011001112246962877U,
                          12406186145184390807U, 15849039046786891736U, 10450023813501588000U));
}

TEST(SplitMix64, IsTheMixOfACount) {
  SplitMix64 generator(7);
  for (std::uint64_t i = 1; i <= 3; ++i) {
    EXPECT_EQ(generator(), SplitMix64::mix(7 + i * SplitMix64::kIncrement));
  }
}

TEST(UnitShare, CoversTheUnitInterval) {
  EXPECT_EQ(unit_share(0), 0);
  EXPECT_EQ(unit_share(std::uint64_t{1} << 63), 0.5);
  EXPECT_EQ(unit_share(~std::uint64_t{0}), 1 - 0x1p-53);
}

}  // namespace
}  // namespace simbench
