#include "cli/command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "cli/command_line.h"
#include "cli/process.h"
#include "evaluation/scoring/ranked_by.h"
#include "recording/dataset_folder.h"
#include "recording/number_in.h"
#include "reports/text/block.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

// The names of the checks, which CLI11 never shows. In one_of() the words follow, a line each.
constexpr const char* kNumberCheck = "number";
constexpr const char* kWordsCheck = "one of";

// `kind`: what is allowed, "a whole number".
template <class Number>
CLI::Validator within(const char* kind, Number low, Number high) {
  const auto check = [kind, low, high](const std::string& text) -> std::string {
    const std::optional<Number> value = number_in<Number>(text);
    if (value && low <= *value && *value <= high) return "";
    return fmt::format("found '{}', allowed: {} from {} to {}", text, kind, low, high);
  };
  return {check, "", kNumberCheck};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [words](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return "";
    return fmt::format("found '{}', allowed: {}", text, fmt::join(words, ", "));
  };
  return {check, "", fmt::format("{}\n{}", kWordsCheck, fmt::join(words, "\n"))};
}

CLI::Validator not_empty() {
  const auto check = [](const std::string& text) -> std::string {
    return text.empty() ? "found '', allowed: a value that is not empty" : "";
  };
  return {check, ""};
}

// The name of the option's check; empty if it takes no value.
std::string check_name(CLI::Option& option) {
  try {
    return option.get_validator(0)->get_name();
  } catch (const CLI::OptionNotFound&) {
    return "";
  }
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code none;
  return std::filesystem::equivalent(a, b, none);
}

// The files and folders that a given option or argument names, as its place holder says.
std::vector<std::string> named_inputs(const CLI::Option& option) {
  const std::string place = option.get_type_name();
  const auto holds = [&place](const char* word) { return place.find(word) != std::string::npos; };
  if (!holds("INPUT") && !holds("FILE") && !holds("DIR") && !holds("ARCHIVE") &&
      !holds("SCENARIO")) {
    return {};
  }
  std::vector<std::string> inputs = option.results();
  for (const std::string& path : option.results())
    std::ranges::move(dataset_files(path), std::back_inserter(inputs));
  if (holds("=")) {  // NAME=FILE
    for (std::string& input : inputs) input.erase(0, input.find('=') + 1);
  }
  if (holds("SCENARIO")) {
    std::erase_if(inputs, [](const std::string& name) {
      return std::ranges::count(scenarios::builtin_scenarios(), name,
                                &scenarios::BuiltinScenario::name) > 0;
    });
  }
  return inputs;
}

// Refuses an output that would replace an input, or a file that no run makes again.
void check_output(CLI::App& command, CLI::Option& output,
                  const std::vector<CLI::Option*>& outputs) {
  if (output.count() == 0) return;
  const std::string path = output.results().front();
  const char* const other_one = output.get_type_name() == "DIR" ? "another folder" : "another file";
  for (CLI::Option* const other : command.get_options({})) {
    if (std::ranges::find(outputs, other) != outputs.end()) continue;
    for (const std::string& input : named_inputs(*other)) {
      if (!is_same_file(path, input)) continue;
      refuse(output.get_name(),
             fmt::format("{} is one of the inputs, allowed: {}", path, other_one));
    }
  }
  if (const auto why = reports::irreplaceable(path)) {
    refuse(output.get_name(), fmt::format("{} {}, allowed: {}", path, *why, other_one));
  }
}

// Registers the algorithms of these files, or goes on as a program that can.
void import_python(const CommandLine& line, const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (line.extras.import_algorithms == nullptr) become_python_program(line.arguments);
    line.extras.import_algorithms(file);
  }
}

// Adds any option with a value, also one without a name. No `check` takes an empty value.
template <class Value>
CLI::Option* with_value(CLI::App& command, const std::string& names, const std::string& place,
                        Value& value, const std::string& text, CLI::Validator check) {
  return command.add_option(names, value, text)->type_name(place)->check(std::move(check));
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::at_most(int values) {
  option_->expected(1, values);
  return *this;
}

Option& Option::or_nothing() {
  option_->expected(0, 1);
  return *this;
}

Option& Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

bool Option::given() const { return option_->count() > 0; }

Command::Command(CommandLine& line, const std::string& name, const std::string& summary)
    : line_(line), command_(line.parser.add_subcommand(name, summary)) {}

Option Command::flag(const std::string& names, bool& value, const std::string& text) {
  return Option(command_->add_flag(names, value, text));
}

Option Command::text(const std::string& names, const std::string& place, std::string& value,
                     const std::string& text) {
  return Option(with_value(*command_, names, place, value, text, not_empty()));
}

Option Command::output(const std::string& names, const std::string& place, std::string& value,
                       const std::string& text) {
  outputs_.push_back(with_value(*command_, names, place, value, text, not_empty()));
  return Option(outputs_.back());
}

Option Command::texts(const std::string& names, const std::string& place,
                      std::vector<std::string>& values, const std::string& text) {
  CLI::Option* option = with_value(*command_, names, place, values, text, not_empty());
  if (names.starts_with("-")) option->allow_extra_args(false);
  return Option(option);
}

Option Command::list(const std::string& names, const std::string& place,
                     std::vector<std::string>& values, const std::string& text) {
  return Option(with_value(*command_, names, place, values, text, not_empty())
                    ->delimiter(',')
                    ->allow_extra_args(false));
}

Option Command::word(const std::string& names, const std::string& place, std::string& value,
                     const std::vector<std::string>& words, const std::string& text) {
  return Option(with_value(*command_, names, place, value, text, one_of(words)));
}

template <class Number>
Option Command::number(const std::string& names, const std::string& place, Number& value,
                       double low, double high, const std::string& text) {
  CLI::Option* option =
      with_value(*command_, names, place, value, text, within("a number", low, high));
  if constexpr (std::is_same_v<Number, std::vector<double>>) {
    option->delimiter(',')->allow_extra_args(false);
  }
  return Option(option);
}

template Option Command::number(const std::string&, const std::string&, double&, double, double,
                                const std::string&);
template Option Command::number(const std::string&, const std::string&, std::optional<double>&,
                                double, double, const std::string&);
template Option Command::number(const std::string&, const std::string&, std::vector<double>&,
                                double, double, const std::string&);

template <class Number>
Option Command::whole_number(const std::string& names, const std::string& place, Number& value,
                             std::uint64_t low, std::uint64_t high, const std::string& text) {
  return Option(
      with_value(*command_, names, place, value, text, within("a whole number", low, high)));
}

template <class Number>
Option Command::seed(const std::string& names, Number& value, const std::string& text) {
  return whole_number(names, "K", value, 0, std::numeric_limits<std::uint32_t>::max(), text);
}

template <class Number>
Option Command::count(const std::string& names, Number& value, const std::string& text) {
  return whole_number(names, "N", value, 1, 1'000'000, text);
}

template Option Command::whole_number(const std::string&, const std::string&, std::uint64_t&,
                                      std::uint64_t, std::uint64_t, const std::string&);
template Option Command::whole_number(const std::string&, const std::string&, std::int64_t&,
                                      std::uint64_t, std::uint64_t, const std::string&);
template Option Command::whole_number(const std::string&, const std::string&,
                                      std::optional<std::uint64_t>&, std::uint64_t, std::uint64_t,
                                      const std::string&);
template Option Command::seed(const std::string&, std::uint64_t&, const std::string&);
template Option Command::seed(const std::string&, std::optional<std::uint64_t>&,
                              const std::string&);
template Option Command::count(const std::string&, std::uint64_t&, const std::string&);
template Option Command::count(const std::string&, std::optional<std::uint64_t>&,
                               const std::string&);

void Command::scenario(std::string& value) {
  text("--scenario", "SCENARIO", value,
       "Name of a scenario (see `simbench list`) or path of a scenario file")
      .required();
}

void Command::pipelines(std::vector<std::string>& names, const std::string& others) {
  list("--pipelines", "PIPELINE,...", names,
       "Only these pipelines of the scenario, in this order; others by their\n"
       "algorithms (`simbench list`): " +
           others);
}

void Command::rank_by(std::string& metric) {
  word("--rank-by", "METRIC", metric, evaluation::ranking_metrics(),
       "Rank the pipelines by this metric. Default: AMD, or in a table of steered\n"
       "exposures their spread");
}

void Command::sets(std::vector<std::string>& values) {
  const auto check = [](const std::string& text) -> std::string {
    if (text.starts_with("/") && text.find('=') != std::string::npos) return "";
    return fmt::format("found '{}', allowed: /json/pointer=value, as in /timeline/frames=100",
                       text);
  };
  with_value(*command_, "--set", "/POINTER=VALUE", values,
             "Change a parameter of the scenario, repeatable;\n"
             "`simbench describe SCENARIO` lists all parameters",
             CLI::Validator(check, ""))
      ->allow_extra_args(false);
}

void Command::python() {
  python_files_ = std::make_shared<std::vector<std::string>>();
  texts("--python", "FILE", *python_files_,
        "Add the algorithms of this Python file (docs/python.md); repeatable");
}

void Command::jobs(unsigned& value, const std::string& text) {
  whole_number("--jobs", "N", value, 1, 4096, text);
}

void Command::format(std::string& value, const std::vector<std::string>& formats) {
  value = formats.front();
  const Option option =
      word("--format", "FORMAT", value, formats,
           fmt::format("One of: {}. Default: {}", fmt::join(formats, ", "), value));
  if (std::ranges::count(formats, "latex") > 0) table_columns(value);
  if (std::find(formats.begin(), formats.end(), "json") == formats.end()) return;
  // Options are processed in the order of their addition, so --format is known here.
  json_flag(
      "For scripts: --format json, and progress, warnings and errors on\n"
      "standard error as JSON lines",
      [option, &value] {
        if (option.given() && value != "json") {
          refuse(
              "--json",
              fmt::format("found with --format {}, allowed: --format json, or no --format at all",
                          value));
        }
        value = "json";
      });
}

// `format`: as given; it lives as long as the command's options.
void Command::table_columns(const std::string& format) {
  list("--table-columns", "NAME,...", *table_columns_,
       "Of tables, Markdown and LaTeX: only the columns of these headings, beside those that\n"
       "name a row: 'AMD median,recall'");
  checks_.emplace_back([names = table_columns_, &format] {
    if (names->empty() || format == "table" || format == "markdown" || format == "latex") return;
    refuse("--table-columns",
           fmt::format("found with --format {}, allowed with: table, markdown, latex", format));
  });
}

void Command::json_messages() {
  json_flag(
      "For scripts: progress, warnings and errors on standard error as\n"
      "JSON lines",
      [] {});
}

void Command::json_flag(const std::string& text, std::function<void()> action) {
  command_->add_flag_callback("--json", std::move(action), text)->disable_flag_override();
}

void Command::footer(const std::string& text) { command_->footer(text); }

void Command::runs(Action action, const std::function<void()>& check) {
  command_->callback([&line = line_, action = std::move(action), check, files = python_files_,
                      command = command_, outputs = outputs_, checks = checks_,
                      columns = table_columns_] {
    for (CLI::Option* const output : outputs) check_output(*command, *output, outputs);
    for (const auto& each : checks) each();
    if (check) check();
    line.action = [&line, action, files, columns] {
      if (files) import_python(line, *files);
      reports::set_table_columns(*columns);
      return action();
    };
  });
}

std::vector<scenarios::Override> overrides_of(const std::vector<std::string>& values) {
  std::vector<scenarios::Override> overrides;
  for (const std::string& text : values) {
    const std::size_t equals = text.find('=');
    overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return overrides;
}

void refuse(const std::string& option, const std::string& text) {
  throw CLI::ValidationError(option, text);
}

std::vector<std::string> allowed_words(CLI::Option& option) {
  std::vector<std::string> words = CLI::detail::split(check_name(option), '\n');
  if (words.empty() || words.front() != kWordsCheck) return {};
  words.erase(words.begin());
  return words;
}

bool takes_number(CLI::Option& option) { return check_name(option) == kNumberCheck; }

}  // namespace simbench::cli
