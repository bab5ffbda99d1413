# Writes OUTPUT: the schemas, scenarios, profiles, parts, studies and real recordings of FOLDER as the
# C++ source behind scenarios/builtin_files.h. Run by the build whenever one of the files has changed.

# Sets `result` to an expression of the text, in literals below the 64 KiB that compilers must take.
function(text_expression text result)
  set(expression "std::string()")
  string(LENGTH "${text}" rest)
  while(rest GREATER 0)
    string(SUBSTRING "${text}" 0 60000 piece)
    if(rest GREATER 60000)
      string(FIND "${piece}" "\n" length REVERSE)
      string(SUBSTRING "${text}" 0 ${length} piece)
    endif()
    string(LENGTH "${piece}" length)
    string(SUBSTRING "${text}" ${length} -1 text)
    string(LENGTH "${text}" rest)
    string(APPEND expression "\n      .append(R\"json(${piece})json\")")
  endwhile()
  set(${result} "${expression}" PARENT_SCOPE)
endfunction()

# Sets `result` to the initializers of the files of a folder, and `schema` to the text of its schema
# as an expression.
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
  text_expression("${schema_text}" schema_text)
  set(${result} "${entries}" PARENT_SCOPE)
  set(${schema} "${schema_text}" PARENT_SCOPE)
endfunction()

read_folder(${FOLDER} scenarios schema)
read_folder(${FOLDER}/cameras cameras camera_schema)
read_folder(${FOLDER}/oscillators oscillators oscillator_schema)
read_folder(${FOLDER}/parts parts part_schema)
read_folder(${FOLDER}/studies studies study_schema)
read_folder(${FOLDER}/reality recordings recording_schema)

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "scenarios/builtin_files.h"

#include <string>

namespace simbench::scenarios {

const std::vector<BuiltinFile>& builtin_files() {
  static const std::vector<BuiltinFile> files = {
@scenarios@  };
  return files;
}

std::string_view schema_text() {
  static const std::string text = @schema@;
  return text;
}

const std::vector<BuiltinFile>& camera_files() {
  static const std::vector<BuiltinFile> files = {
@cameras@  };
  return files;
}

std::string_view camera_schema_text() {
  static const std::string text = @camera_schema@;
  return text;
}

const std::vector<BuiltinFile>& oscillator_files() {
  static const std::vector<BuiltinFile> files = {
@oscillators@  };
  return files;
}

std::string_view oscillator_schema_text() {
  static const std::string text = @oscillator_schema@;
  return text;
}

const std::vector<BuiltinFile>& part_files() {
  static const std::vector<BuiltinFile> files = {
@parts@  };
  return files;
}

std::string_view part_schema_text() {
  static const std::string text = @part_schema@;
  return text;
}

const std::vector<BuiltinFile>& study_files() {
  static const std::vector<BuiltinFile> files = {
@studies@  };
  return files;
}

std::string_view study_schema_text() {
  static const std::string text = @study_schema@;
  return text;
}

const std::vector<BuiltinFile>& recording_files() {
  static const std::vector<BuiltinFile> files = {
@recordings@  };
  return files;
}

std::string_view recording_schema_text() {
  static const std::string text = @recording_schema@;
  return text;
}

}  // namespace simbench::scenarios
]])
