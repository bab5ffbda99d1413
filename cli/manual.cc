#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "cli/command_table.h"
#include "recording/collected.h"
#include "recording/version.h"

namespace simbench::cli {
namespace {

// A line of text, escaped for troff.
std::string troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '"':
        out += "\\(dq";
        break;
      default:
        out += c;
    }
  }
  return out.starts_with(".") ? "\\&" + out : out;
}

std::string bold(const std::string& text) { return fmt::format("\\fB{}\\fR", troff(text)); }
std::string italic(const std::string& text) { return fmt::format("\\fI{}\\fR", troff(text)); }

std::string heading(const std::string& text) { return fmt::format(".SH {}\n", text); }

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string page_name(const CommandEntry& command) {
  return command.name.empty() ? "simbench" : "simbench-" + command.name;
}

std::string top(const CommandEntry& command) {
  const std::string name = page_name(command);
  return fmt::format(".TH {} 1 \"\" \"simbench {}\" \"User Commands\"\n{}{} \\- {}\n",
                     troff(upper(name)), version(), heading("NAME"), troff(name),
                     troff(command.text));
}

// "-h, --help", "--seeds N".
std::string option_term(const OptionEntry& option) {
  std::string term;
  for (const std::string& name : option.names) {
    term += (term.empty() ? "" : ", ") + bold(name);
  }
  return option.value_name.empty() ? term : fmt::format("{} {}", term, italic(option.value_name));
}

std::string tagged(const std::string& term, const OptionEntry& entry) {
  return fmt::format(".TP\n{}\n{}{}\n", term, entry.required ? "Required. " : "",
                     troff(entry.text));
}

std::string synopsis(const CommandEntry& command) {
  std::string text = fmt::format("{}\n", bold("simbench " + command.name));
  for (const OptionEntry& option : command.options) {
    if (option.required) text += option_term(option) + "\n";
  }
  text += fmt::format("[{}]\n", italic("OPTION..."));
  for (const OptionEntry& argument : command.arguments) {
    text += argument.required ? italic(argument.value_name)
                              : fmt::format("[{}]", italic(argument.value_name));
    text += "\n";
  }
  return heading("SYNOPSIS") + text;
}

std::string entries(const CommandEntry& command) {
  std::string text;
  if (!command.arguments.empty()) text += heading("ARGUMENTS");
  for (const OptionEntry& argument : command.arguments) {
    text += tagged(italic(argument.value_name), argument);
  }
  text += heading("OPTIONS");
  for (const OptionEntry& option : command.options) {
    text += tagged(option_term(option), option);
  }
  return text;
}

using Lines = std::vector<std::string>;

std::vector<Lines> paragraphs(const std::string& text) {
  std::vector<Lines> found(1);
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) {
      found.back().push_back(line);
    } else if (!found.back().empty()) {
      found.emplace_back();
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

// Indented lines stay as they are, the others become prose.
std::string body(const Lines& lines) {
  std::string text;
  bool as_it_is = false;
  for (const std::string& line : lines) {
    const bool indented = line.starts_with(" ");
    if (indented != as_it_is) text += indented ? ".PP\n.nf\n" : ".fi\n";
    as_it_is = indented;
    text += fmt::format("{}\n", troff(line));
  }
  return text + (as_it_is ? ".fi\n" : "");
}

struct Footer {
  std::string description;
  std::string examples;
  std::string exit_status;
};

Footer divided(const CommandEntry& command) {
  Footer footer;
  for (const Lines& lines : paragraphs(command.footer)) {
    const std::string& first = lines.front();
    if (first.starts_with("Example") || first.starts_with("Start here")) {
      footer.examples += body({lines.begin() + 1, lines.end()});
    } else if (first.starts_with("Exit status:")) {
      Lines rest = lines;
      rest.front().erase(0, std::string("Exit status: ").size());
      footer.exit_status += body(rest);
    } else {
      footer.description += ".PP\n" + body(lines);
    }
  }
  return footer;
}

std::string section(const char* name, const std::string& text) {
  return text.empty() ? "" : heading(name) + text;
}

constexpr const char* kEnvironment = R"(.TP
.B COLUMNS
The width of tables and text. Default: the terminal's; unlimited for a file or a pipe.
.TP
.B NO_COLOR
No colour, if it is not empty.
.TP
.B CLICOLOR
No colour, if it is 0.
)";

std::string references(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += fmt::format(".BR {} (1){}\n", troff(name), &name == &names.back() ? "" : ",");
  }
  return section("SEE ALSO", text);
}

// The commands below their groups, in order.
std::string command_list(const CommandTable& table) {
  std::string text;
  std::string group;
  for (const CommandEntry& command : table.commands) {
    if (command.group != group) text += fmt::format(".SS {}\n", troff(command.group));
    group = command.group;
    text += fmt::format(".TP\n{}\n{}\n", bold(command.name), troff(command.text));
  }
  return text;
}

}  // namespace

std::string manual_page(const CommandTable& table) {
  const CommandEntry& program = table.program;
  const Footer footer = divided(program);
  const std::vector<std::string> pages = collected(table.commands, page_name);
  return top(program) +
         fmt::format("{}{}\n{}\n[{}]\n", heading("SYNOPSIS"), bold("simbench"), italic("COMMAND"),
                     italic("OPTION...")) +
         section("DESCRIPTION", footer.description) + section("COMMANDS", command_list(table)) +
         entries(program) + section("EXAMPLES", footer.examples) +
         section("EXIT STATUS", footer.exit_status) + section("ENVIRONMENT", kEnvironment) +
         references(pages);
}

std::string manual_page(const CommandTable& table, const CommandEntry& command) {
  const Footer footer = divided(command);
  return top(command) + synopsis(command) +
         section("DESCRIPTION", troff(command.text) + ".\n" + footer.description) +
         entries(command) + section("EXAMPLES", footer.examples) +
         section("EXIT STATUS", footer.exit_status) + references({page_name(table.program)});
}

}  // namespace simbench::cli
