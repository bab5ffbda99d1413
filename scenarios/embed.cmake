# Writes OUTPUT: the schema and the scenarios of FOLDER as the C++ source behind
# scenarios/builtin_files.h. Run by the build whenever one of the files has changed.
file(GLOB files ${FOLDER}/*.json)
list(REMOVE_ITEM files ${FOLDER}/schema.json)
list(SORT files)

set(scenarios "")
foreach(path IN LISTS files)
  cmake_path(GET path STEM LAST_ONLY name)
  file(READ ${path} text)
  string(APPEND scenarios "      {\"${name}\", R\"json(${text})json\"},\n")
endforeach()
file(READ ${FOLDER}/schema.json schema)

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "scenarios/builtin_files.h"

namespace simbench::scenarios {

const std::vector<BuiltinFile>& builtin_files() {
  static const std::vector<BuiltinFile> files = {
@scenarios@  };
  return files;
}

std::string_view schema_text() { return R"json(@schema@)json"; }

}  // namespace simbench::scenarios
]])
