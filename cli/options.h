// Options that several subcommands share, and the checks that make their messages alike:
// "--seeds: found 'many', allowed: a whole number from 1 to 1000000".
#ifndef SIMBENCH_CLI_OPTIONS_H_
#define SIMBENCH_CLI_OPTIONS_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/messages.h"
#include "scenarios/loader.h"

namespace simbench::cli {

// What a subcommand does once its options are parsed; returns the exit status. Each
// add_..._command() below the folder tools/ adds one subcommand, which puts its action here.
using Action = std::function<int()>;

// The checks say what they allow to whoever completes a command line as well (allowed_words(),
// takes_number()), so a check of one's own is not known to the shells.
//
// A whole number within [low, high].
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);

// A number within [low, high].
CLI::Validator number_within(double low, double high);

// One of the given words.
CLI::Validator one_of(const std::vector<std::string>& words);

// The words of an option's one_of(); empty for another option.
std::vector<std::string> allowed_words(CLI::Option& option);

// Whether an option has a whole_number() or a number_within().
bool takes_number(CLI::Option& option);

// --set /json/pointer=value, repeatable; parsed by overrides_of().
void add_set_option(CLI::App& command, std::vector<std::string>& values);
std::vector<scenarios::Override> overrides_of(const std::vector<std::string>& values);

// Defaults are stated in the texts of the options ("Default: ...").
// --format with the first of `formats` as its default; where they include "json" also --json, which
// sets that and makes the messages on standard error JSON lines (cli/messages.h).
void add_format_option(CLI::App& command, std::string& format,
                       const std::vector<std::string>& formats);

// --json for a command whose result is a file: messages as JSON lines only.
void add_json_messages_option(CLI::App& command);

// Writes the result to standard output. Throws std::runtime_error if that fails (a full disk).
void print_result(const std::string& text);
}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_OPTIONS_H_
