// The choices of a scenario: an enum for each member whose values are words, and its words.
//
// The enums are made from the "enum" lists of scenarios/schema.json, in their order: "full_slave"
// of the type SyncMode is SyncMode::kFullSlave. The meaning of each value is documented at its
// member (scenarios/scenario.h); words.h has the functions of words.
//
//   const SyncMode mode = from_text<SyncMode>("genlock").value();
//   const bool follows_pulses = waits_for_trigger(mode);  // true
#pragma once

#include "scenarios/schema_choices.h"

namespace simbench::scenarios {

// Whether cameras in this mode wait for the pulses of the rig's trigger. Which of their streams
// follow the pulses depends on the model: Cameras::follows_trigger().
constexpr bool waits_for_trigger(SyncMode mode) {
  return mode != SyncMode::kDefault && mode != SyncMode::kMaster;
}

constexpr bool walks(MotionScript motion) {
  return motion == MotionScript::kWalk || motion == MotionScript::kWalkAndTurn;
}
constexpr bool turns(MotionScript motion) {
  return motion == MotionScript::kTurn || motion == MotionScript::kWalkAndTurn;
}

}  // namespace simbench::scenarios
