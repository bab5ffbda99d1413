// A rig file as checked JSON: what the schema says, and nothing of what the members mean together.
#ifndef SIMBENCH_HARDWARE_RIG_RIG_DOCUMENT_H_
#define SIMBENCH_HARDWARE_RIG_RIG_DOCUMENT_H_

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/places.h"

namespace simbench::hardware {

struct RigDocument {
  nlohmann::json root;
  scenarios::Places places;
};

// The text of the file. Throws InputError.
std::string read_rig_text(const std::string& path);

// Throws InputError for what is no JSON or is refused by hardware/rig/schema.json.
RigDocument parse_rig_document(const std::string& text, const std::string& path);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_RIG_RIG_DOCUMENT_H_
