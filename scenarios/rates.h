// At which rates the cameras of a scenario deliver, and whether their sync mode allows them.
//
// Sources: librealsense, option Inter Cam Sync Mode and issues #12560 (genlock takes a pulse every
// two frame times at most), #15119 (only depth is genlocked); Intel's page on external
// synchronisation (which mode rates slaves accept, in a window "so strict" that its size is not
// given: 1 % is an assumption).
#ifndef SIMBENCH_SCENARIOS_RATES_H_
#define SIMBENCH_SCENARIOS_RATES_H_

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Whether the sync mode lets the trigger decide when the stream exposes: in slave and genlock for
// depth only, in full_slave for both, in default and master for none.
bool follows_trigger(const Cameras& cameras, const Stream& stream);

// The rate of the pulses, with the trigger's own rate error.
double pulse_rate_hz(const Trigger& trigger);

// The rate at which a stream delivers frames if none is lost.
double frame_rate_hz(const Scenario& scenario, const Stream& stream);

// Throws InputError about the first profile that a D455 does not offer, or rate that the sync mode
// does not allow.
void check_rates(const Scenario& scenario);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_RATES_H_
