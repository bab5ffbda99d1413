# Writes OUTPUT: the completion scripts of FOLDER as the C++ source behind cli/completion_scripts.h.
# Run by the build whenever one of them has changed.
foreach(shell bash zsh fish)
  file(READ ${FOLDER}/simbench.${shell} ${shell})
endforeach()

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "cli/completion_scripts.h"

namespace simbench::cli::completion {

std::string_view bash_script() { return R"embedded(@bash@)embedded"; }
std::string_view zsh_script() { return R"embedded(@zsh@)embedded"; }
std::string_view fish_script() { return R"embedded(@fish@)embedded"; }

}  // namespace simbench::cli::completion
]])
