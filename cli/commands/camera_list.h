// What `simbench list cameras` prints: the profiles of camera models (scenarios/camera_profile.h).
#ifndef SIMBENCH_CLI_COMMANDS_CAMERA_LIST_H_
#define SIMBENCH_CLI_COMMANDS_CAMERA_LIST_H_

#include <string>

namespace simbench::cli {

// All models for people: streams with sizes and rates, sync modes, stamps, latency, each with its
// source.
std::string camera_list_text();

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_CAMERA_LIST_H_
