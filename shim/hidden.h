// What of the machine is out of a program's sight: its clocks behind the vDSO, the processor's
// counter, the chance in the auxiliary vector.
//
//   set_counter_hidden(false);  // before exec(): the loader reads it
//   print(shim_path());
#pragma once

namespace simbench::shim {

// Whether reading the processor's counter of cycles is the world's clock. It outlasts exec().
void set_counter_hidden(bool hidden);
// The file of the shim, as LD_PRELOAD had it.
const char* shim_path();

}  // namespace simbench::shim
