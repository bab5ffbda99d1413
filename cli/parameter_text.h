// What an algorithm declares of a parameter, in the words of `list algorithms` and `describe`.
//
//   const ParameterSpec spec{.name = "points", .fallback = 16, .low = 1, .high = 100, .choices =
//   {},
//       .meaning = "of the fit", .source = "assumption"};
//   default_text(spec);  // "16"
//   range_text(spec);    // "1 to 100"
#pragma once

#include <string>

#include "algorithms/parameters.h"

namespace simbench::cli {

std::string default_text(const ParameterSpec& spec);

// What is allowed: "1 to 100", "true, false", or the choices.
std::string range_text(const ParameterSpec& spec);

}  // namespace simbench::cli
