// The JSON schema of rig files, built into the program from hardware/rig/schema.json.
#ifndef SIMBENCH_HARDWARE_RIG_RIG_SCHEMA_H_
#define SIMBENCH_HARDWARE_RIG_RIG_SCHEMA_H_

#include <string_view>

namespace simbench::hardware {

std::string_view rig_schema_text();

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_RIG_RIG_SCHEMA_H_
