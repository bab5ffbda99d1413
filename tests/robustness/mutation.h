// Hostile changes of a text: bytes, lines, numbers and words.
#pragma once

#include <string>

#include "tests/robustness/random.h"

namespace simbench::robustness {

// A number or word that a parser has reason to fear.
std::string hostile_word(Random& random);

// The text after one to four changes: bytes flipped, parts removed, doubled, swapped or cut off,
// numbers and words replaced.
std::string mutated(std::string text, Random& random);

}  // namespace simbench::robustness
