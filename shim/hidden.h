// What of the machine is out of a program's sight: its clocks behind the vDSO, the processor's
// counter, chance and users in the auxiliary vector.
//
//   set_counter_hidden(false);  // before exec(): the loader reads it
//   print(shim_path());
#pragma once

#include <cstdint>

namespace simbench::shim {

// Whether reading the processor's counter of cycles is the world's clock. It outlasts exec().
void set_counter_hidden(bool hidden);
// What the machine has the program's files made by.
struct MachineIds {
  std::uint32_t user = 0;
  std::uint32_t group = 0;
};
const MachineIds& machine_ids();
// The file of the shim, as LD_PRELOAD had it.
const char* shim_path();

}  // namespace simbench::shim
