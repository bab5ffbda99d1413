# Writes OUTPUT: the schemas, scenarios, profiles, parts and studies of FOLDER as the C++ source behind
# scenarios/builtin_files.h. Run by the build whenever one of the files has changed.

# Sets `result` to the initializers of the files of a folder, and `schema` to the text of its schema.
function(read_folder folder result schema)
  file(GLOB files ${folder}/*.json)
  list(REMOVE_ITEM files ${folder}/schema.json)
  list(SORT files)
  set(entries "")
  foreach(path IN LISTS files)
    cmake_path(GET path STEM LAST_ONLY name)
    file(READ ${path} text)
    string(APPEND entries "      {\"${name}\", R\"json(${text})json\"},\n")
  endforeach()
  file(READ ${folder}/schema.json schema_text)
  # Without its indentation: compilers need not take literals beyond 64 KiB.
  string(REGEX REPLACE "\n +" "\n" schema_text "${schema_text}")
  set(${result} "${entries}" PARENT_SCOPE)
  set(${schema} "${schema_text}" PARENT_SCOPE)
endfunction()

read_folder(${FOLDER} scenarios schema)
read_folder(${FOLDER}/cameras cameras camera_schema)
read_folder(${FOLDER}/oscillators oscillators oscillator_schema)
read_folder(${FOLDER}/parts parts part_schema)
read_folder(${FOLDER}/studies studies study_schema)

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "scenarios/builtin_files.h"

namespace simbench::scenarios {

const std::vector<BuiltinFile>& builtin_files() {
  static const std::vector<BuiltinFile> files = {
@scenarios@  };
  return files;
}

std::string_view schema_text() { return R"json(@schema@)json"; }

const std::vector<BuiltinFile>& camera_files() {
  static const std::vector<BuiltinFile> files = {
@cameras@  };
  return files;
}

std::string_view camera_schema_text() { return R"json(@camera_schema@)json"; }

const std::vector<BuiltinFile>& oscillator_files() {
  static const std::vector<BuiltinFile> files = {
@oscillators@  };
  return files;
}

std::string_view oscillator_schema_text() { return R"json(@oscillator_schema@)json"; }

const std::vector<BuiltinFile>& part_files() {
  static const std::vector<BuiltinFile> files = {
@parts@  };
  return files;
}

std::string_view part_schema_text() { return R"json(@part_schema@)json"; }

const std::vector<BuiltinFile>& study_files() {
  static const std::vector<BuiltinFile> files = {
@studies@  };
  return files;
}

std::string_view study_schema_text() { return R"json(@study_schema@)json"; }

}  // namespace simbench::scenarios
]])
