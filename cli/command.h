// A subcommand: its options, its help and its action. A thin layer over the parser (CLI11), so that
// all commands have the same messages ("--seeds: found 'many', allowed: a whole number from 1 to
// 1000000"), shells can complete every value, and no command compiles CLI11, which takes seconds.
//
//   void add_validate_command(CommandLine& line) {
//     auto files = std::make_shared<std::vector<std::string>>();
//     Command command(line, "validate", "Check scenario files without running them");
//     command.texts("files", "FILE...", *files, "Scenario files").required();
//     command.footer(kValidateExamples);
//     command.runs([files] { return validate_all(*files); });
//   }
//
// Names: "--seed", "-o,--output", or "files" for an argument without a name, which help and
// messages call by its place holder. The place holder also tells the shells what to offer
// (value_kind() in cli/command_table.cc): SCENARIO, DIR, ARCHIVE and others, else a file. Help
// lists options in the order in which they are added. The variable of an option must live as long
// as the action; its value is the default, which the text states ("Default: 32").
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/stage.h"
#include "cli/messages.h"
#include "scenarios/loader.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the parser calls it so
class App;
class Option;
}  // namespace CLI

namespace simbench {
struct CommandLineExtras;
}

namespace simbench::cli {

// Runs a subcommand after its options are parsed; returns the exit status.
using Action = std::function<int()>;

// A command line to which commands are added.
struct CommandLine {
  CLI::App& parser;
  const std::vector<std::string>& arguments;  // as given, with the program's name
  const CommandLineExtras& extras;            // cli/command_line.h
  Action action{};                            // of the command that was parsed
};

class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option& required();
  Option& at_most(int values);
  Option& or_nothing();  // may stand without its value
  Option& needs(const Option& other);
  Option& excludes(const Option& other);
  bool given() const;  // once the command line is parsed

 private:
  CLI::Option* option_;
};

class Command {
 public:
  Command(CommandLine& line, const std::string& name, const std::string& summary);

  Option flag(const std::string& names, bool& value, const std::string& text);
  Option text(const std::string& names, const std::string& place, std::string& value,
              const std::string& text);
  // An option that may be repeated, or all arguments that follow.
  Option texts(const std::string& names, const std::string& place, std::vector<std::string>& values,
               const std::string& text);
  // A file or folder that the command writes. Before the action and its check, one that is also an
  // input is refused, and so is a file that is never replaced (reports/text/output_file.h): no
  // command destroys its inputs. Inputs are the other options and arguments whose place holder has
  // the word INPUT, FILE, DIR, ARCHIVE or SCENARIO.
  Option output(const std::string& names, const std::string& place, std::string& value,
                const std::string& text);
  // "one,two"; may be repeated.
  Option list(const std::string& names, const std::string& place, std::vector<std::string>& values,
              const std::string& text);
  Option word(const std::string& names, const std::string& place, std::string& value,
              const std::vector<std::string>& words, const std::string& text);
  // Within [low, high]. Number: double or std::optional<double>, and std::vector<double> for "1,2".
  template <class Number>
  Option number(const std::string& names, const std::string& place, Number& value, double low,
                double high, const std::string& text);
  // Number: std::uint64_t, std::int64_t, unsigned, std::optional<std::uint64_t>.
  template <class Number>
  Option whole_number(const std::string& names, const std::string& place, Number& value,
                      std::uint64_t low, std::uint64_t high, const std::string& text);

  // Options of many commands.
  //
  // --scenario, required.
  void scenario(std::string& value);
  // --pipelines of the scenario. `others`: how pipelines are stated that it does not have.
  void pipelines(std::vector<std::string>& names,
                 const std::string& others = stages_formula(kPipelineStages));
  // --set /json/pointer=value, repeatable; parsed by overrides_of().
  void sets(std::vector<std::string>& values);
  // --rank-by: a metric by which results may be ranked; "" if it is not given.
  void rank_by(std::string& metric);
  // --python: files whose algorithms there are besides; before runs().
  void python();
  // --first-seed, --seed and the like.
  template <class Number>
  Option seed(const std::string& names, Number& value, const std::string& text);
  // --seeds, --repeats and the like: from 1.
  template <class Number>
  Option count(const std::string& names, Number& value, const std::string& text);
  // --jobs: threads.
  void jobs(unsigned& value, const std::string& text = "Threads. Default: one for every core");
  // --format with the first of `formats` as its default; where they include "json" also --json,
  // which sets that and makes the messages on standard error JSON lines (cli/messages.h); where
  // they include "latex" also --table-columns, for every format of reports::drawn_as().
  void format(std::string& value, const std::vector<std::string>& formats);
  // --json for a command whose result is a file: messages as JSON lines only.
  void json_messages();

  // The help below the options: explanation, examples, exit status (cli/command_table.h divides
  // it).
  void footer(const std::string& text);
  // `check` is called while parsing: it may refuse().
  void runs(Action action, const std::function<void()>& check = {});

 private:
  void json_flag(const std::string& text, std::function<void()> action);
  void table_columns(const std::string& format);

  CommandLine& line_;
  CLI::App* command_;
  std::shared_ptr<std::vector<std::string>> python_files_;  // null without --python
  std::shared_ptr<std::vector<std::string>> table_columns_ =
      std::make_shared<std::vector<std::string>>();
  std::vector<CLI::Option*> outputs_;
  std::vector<std::function<void()>> checks_;  // while parsing, before that of runs()
};

std::vector<scenarios::Override> overrides_of(const std::vector<std::string>& values);

// Ends parsing with the message "OPTION: text" and a pointer to the help.
[[noreturn]] void refuse(const std::string& option, const std::string& text);

// For completion: the words of an option's word(), empty for other options; whether it is a
// number() or whole_number().
std::vector<std::string> allowed_words(CLI::Option& option);
bool takes_number(CLI::Option& option);

}  // namespace simbench::cli
