// Damaged scenarios: every one loads or fails with an InputError of one line.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

std::string damaged(std::string text, std::mt19937& random) {
  const std::string bytes = "{}[]\",:0-9.eE+nulltrue \n\t/~\\\x7f\x80\xff";
  const auto below = [&random](std::size_t end) { return random() % end; };
  for (std::size_t edits = 1 + below(3); edits > 0 && !text.empty(); --edits) {
    const std::size_t at = below(text.size());
    switch (below(4)) {
      case 0:
        text[at] = bytes[below(bytes.size())];
        break;
      case 1:
        text.erase(at, 1 + below(20));
        break;
      case 2:
        text.insert(at, 1, bytes[below(bytes.size())]);
        break;
      default:
        text.insert(at, text.substr(below(text.size()), below(60)));
    }
  }
  return text;
}

TEST(Mutation, LoadsOrSaysWhatIsWrongInOneLine) {
  const std::string whole = load_scenario("18cam_6host_45fps").resolved_json();
  const std::string small = derived(R"("faults": [{"kind": "clock_step", "host": 1, "at_ms": 1,
    "step_ms": 2}], "trigger": {"pauses": [{"at_ms": 1, "duration_ms": 2}]})");
  for (std::mt19937::result_type seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    const std::string message = error_of_text(damaged(seed % 2 == 0 ? whole : small, random));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "seed " << seed << ": " << message;
    EXPECT_LT(message.size(), 2000U) << "seed " << seed << ": " << message;
  }
}

}  // namespace
}  // namespace simbench::scenarios
