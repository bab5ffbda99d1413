// What the terminal can show.
#ifndef SIMBENCH_CLI_TERMINAL_H_
#define SIMBENCH_CLI_TERMINAL_H_

#include <cstddef>
#include <optional>

namespace simbench::cli {

// How wide text on standard output may be, in columns: COLUMNS if it is a number of at least
// kNarrowest, else the width of the terminal that standard output is; std::nullopt (as wide as need
// be) for a file or a pipe.
inline constexpr std::size_t kNarrowest = 20;
std::optional<std::size_t> width_of_output();

// Whether a terminal takes escape sequences: TERM is set and not "dumb".
bool takes_escapes();

// Whether colour is wanted: neither NO_COLOR (no-color.org) nor CLICOLOR=0 (bixense.com/clicolors).
bool wants_colour();

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_TERMINAL_H_
