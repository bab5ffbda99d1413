// How --help looks: CLI11's layout with texts wrapped to the page, at most kHelpWidth columns.
#ifndef SIMBENCH_CLI_HELP_FORMAT_H_
#define SIMBENCH_CLI_HELP_FORMAT_H_

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <string_view>

namespace simbench::cli {

inline constexpr std::size_t kHelpWidth = 100;

// For CLI::App::formatter(); subcommands added later have it as well.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;
};

// Puts the subcommands that have no group of their own yet into `group`, under which the help lists
// them.
void group_commands(CLI::App& app, const std::string& group);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_HELP_FORMAT_H_
