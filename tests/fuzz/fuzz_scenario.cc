// The scenario loader: any text is a scenario or an InputError, nothing else.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/loader.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A first line "/pointer=value" is an override, the rest the file.
  std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<simbench::scenarios::Override> overrides;
  if (text.starts_with('/')) {
    const std::size_t end = text.find('\n');
    const std::string line = text.substr(0, end);
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos) {
      overrides.push_back({line.substr(0, equals), line.substr(equals + 1)});
    }
    text.erase(0, end == std::string::npos ? end : end + 1);
  }
  try {
    const auto scenario = simbench::scenarios::load_scenario_text(text, "fuzz.json", overrides);
    simbench::scenarios::warnings(scenario);
    simbench::scenarios::describe(scenario);
  } catch (const simbench::scenarios::InputError&) {
  }
  return 0;
}
