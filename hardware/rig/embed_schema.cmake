# Writes OUTPUT: the text of SCHEMA as the C++ source behind hardware/rig/rig_schema.h. Run by the
# build whenever the schema has changed.
file(READ ${SCHEMA} schema)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "hardware/rig/rig_schema.h"

namespace simbench::hardware {

std::string_view rig_schema_text() { return R"json(@schema@)json"; }

}  // namespace simbench::hardware
]])
