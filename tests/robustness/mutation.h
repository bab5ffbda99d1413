// Hostile changes of a text: bytes, lines, numbers and words.
#ifndef SIMBENCH_TESTS_ROBUSTNESS_MUTATION_H_
#define SIMBENCH_TESTS_ROBUSTNESS_MUTATION_H_

#include <string>

#include "tests/robustness/random.h"

namespace simbench::robustness {

// A number or word that a parser has reason to fear.
std::string hostile_word(Random& random);

// The text after one to four changes: bytes flipped, parts removed, doubled, swapped or cut off,
// numbers and words replaced.
std::string mutated(std::string text, Random& random);

}  // namespace simbench::robustness

#endif  // SIMBENCH_TESTS_ROBUSTNESS_MUTATION_H_
