# Writes OUTPUT: the text of SCHEMA as the C++ source behind rig_schema_text() of hardware/rig/rig.h. Run by the
# build whenever the schema has changed.
file(READ ${SCHEMA} schema)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "hardware/rig/rig.h"

namespace simbench::hardware {

std::string_view rig_schema_text() { return R"json(@schema@)json"; }

}  // namespace simbench::hardware
]])
