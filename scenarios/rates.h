// At which rates the cameras of a scenario deliver, and whether their model and its sync mode allow
// them.
//
// Sources: the model's profile (scenarios/camera_profile.h); librealsense #12560 (genlock takes a
// pulse every two frame times at most); Intel's page on external synchronisation (slaves accept
// pulses in a window "so strict" that its size is not given: 1 % is an assumption).
#ifndef SIMBENCH_SCENARIOS_RATES_H_
#define SIMBENCH_SCENARIOS_RATES_H_

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Whether the sync mode lets the trigger decide when the stream exposes, by the model's profile.
// Throws std::invalid_argument if there is no such model, which a loaded scenario cannot have.
bool follows_trigger(const Cameras& cameras, const Stream& stream);

// The rate of the pulses, with the trigger's own rate error.
double pulse_rate_hz(const Trigger& trigger);

// The rate at which a stream delivers frames if none is lost.
double frame_rate_hz(const Scenario& scenario, const Stream& stream);

// Throws InputError about a model or sync mode that does not exist, the first image size or rate
// that the model does not offer, or the first rate that its sync mode does not allow.
void check_rates(const Scenario& scenario);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_RATES_H_
