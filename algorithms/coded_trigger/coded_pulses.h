// What a rig's user knows of its coded trigger, for those who find a frame's pulse by it.
//
//   auto pulses = std::make_shared<const CodedPulses>(
//       CodedPulses{.code = TriggerCode::position(from_ms(1000.0 / 90), 12, from_us(50))});
//   auto gatherer = make_coded_trigger_gatherer({.sources = 18, .pulses = pulses}, {});
#pragma once

#include "laws/trigger_code.h"

namespace simbench {

struct CodedPulses {
  TriggerCode code;
  // Which end of an exposure follows its pulse by a constant time: its begin (genlock, industrial
  // cameras), or its end (slaves). Sensor stamps are of the middle, half an exposure apart.
  bool exposures_begin_at_pulse = false;
};

}  // namespace simbench
