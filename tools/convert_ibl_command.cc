#include "tools/convert_ibl_command.h"
namespace simbench::tools {
void add_convert_ibl_command(CLI::App&, Action&) {}
}  // namespace simbench::tools
