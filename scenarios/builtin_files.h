// The files of scenarios/*.json and of its folders cameras, oscillators, parts and studies, built
// into the program by embed.cmake.
#pragma once

#include <string_view>
#include <vector>

namespace simbench::scenarios {

struct BuiltinFile {
  std::string_view name;  // the file's name without ".json"
  std::string_view text;
};

// The scenarios in alphabetical order; the schema is not among them.
const std::vector<BuiltinFile>& builtin_files();

// scenarios/schema.json.
std::string_view schema_text();

// The profiles of camera models, by model, in alphabetical order; their schema is not among them.
const std::vector<BuiltinFile>& camera_files();

// scenarios/cameras/schema.json.
std::string_view camera_schema_text();

// The classes of oscillators in alphabetical order; their schema is not among them.
const std::vector<BuiltinFile>& oscillator_files();

// scenarios/oscillators/schema.json.
std::string_view oscillator_schema_text();

// The parts of rigs in alphabetical order; their schema is not among them.
const std::vector<BuiltinFile>& part_files();

// scenarios/parts/schema.json.
std::string_view part_schema_text();

// The studies in alphabetical order; their schema is not among them.
const std::vector<BuiltinFile>& study_files();

// scenarios/studies/schema.json.
std::string_view study_schema_text();

// The figures of real recordings in alphabetical order; their schema is not among them.
const std::vector<BuiltinFile>& recording_files();

// scenarios/reality/schema.json.
std::string_view recording_schema_text();

}  // namespace simbench::scenarios
