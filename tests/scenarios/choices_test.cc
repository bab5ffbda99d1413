#include "scenarios/choices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace simbench::scenarios {
namespace {

using testing::ElementsAre;

template <class Enum>
class Choices : public testing::Test {};

using AllChoices = testing::Types<StreamKind, StampPoint, SwitchClockKind, ShutterKind, SyncMode,
                                  UsbSharing, TableKind, MedianKind, SubjectKind, MotionScript>;
TYPED_TEST_SUITE(Choices, AllChoices);

TYPED_TEST(Choices, WordsAndValuesStandForEachOther) {
  std::set<TypeParam> values;
  std::set<std::string_view> texts;
  for (const auto& [value, text] : words_of(TypeParam{})) {
    EXPECT_EQ(to_text(value), text);
    EXPECT_EQ(from_text<TypeParam>(text), value) << text;
    EXPECT_TRUE(values.insert(value).second && texts.insert(text).second) << text;
  }
  EXPECT_GE(values.size(), 2U);
  EXPECT_EQ(static_cast<std::size_t>(*values.rbegin()), values.size() - 1) << "a value has no word";
}

TYPED_TEST(Choices, OtherTextIsNoChoice) {
  for (const char* const text : {"", "?", "Depth", "depth ", "burst"}) {
    EXPECT_EQ(from_text<TypeParam>(text), std::nullopt) << text;
  }
  EXPECT_EQ(to_text(static_cast<TypeParam>(99)), "?");
}

TEST(ChoicesTest, AllTextsAreInOrder) {
  EXPECT_THAT(all_texts<SyncMode>(),
              ElementsAre("default", "master", "slave", "full_slave", "genlock"));
}

TEST(ChoicesTest, QuestionsAboutThem) {
  using enum SyncMode;
  for (const SyncMode mode : {kSlave, kFullSlave, kGenlock}) EXPECT_TRUE(waits_for_trigger(mode));
  for (const SyncMode mode : {kDefault, kMaster}) EXPECT_FALSE(waits_for_trigger(mode));
  using enum MotionScript;
  EXPECT_TRUE(walks(kWalk) && walks(kWalkAndTurn));
  EXPECT_FALSE(walks(kStand) || walks(kTurn) || walks(kRaiseArms));
  EXPECT_TRUE(turns(kTurn) && turns(kWalkAndTurn));
  EXPECT_FALSE(turns(kStand) || turns(kWalk) || turns(kRaiseArms));
}

}  // namespace
}  // namespace simbench::scenarios
