// The completion scripts of cli/completion/, embedded by the build (cli/embed_completion.cmake):
// templates of reports/text/escaped_text.h, in which {{NAME}} stands for what follows from the
// commands.
#pragma once

#include <string_view>

namespace simbench::cli::completion {

std::string_view bash_script();
std::string_view zsh_script();
std::string_view fish_script();

}  // namespace simbench::cli::completion
