#include "tools/replay_command.h"
namespace simbench::tools {
void add_replay_command(CLI::App&, Action&, std::vector<std::string>) {}
}  // namespace simbench::tools
