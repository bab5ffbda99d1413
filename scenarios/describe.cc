#include "scenarios/loader.h"
namespace simbench::scenarios {
std::vector<ParameterLine> describe(const Scenario&) { return {}; }
std::vector<std::string> warnings(const Scenario&) { return {}; }
}
