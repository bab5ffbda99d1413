// Options that several subcommands share, and the checks that make their messages alike:
// "--seeds: found 'many', allowed: a whole number from 1 to 1000000".
#ifndef SIMBENCH_TOOLS_OPTIONS_H_
#define SIMBENCH_TOOLS_OPTIONS_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::tools {

// What a subcommand does once its options are parsed; returns the exit status. Each
// add_..._command() below the folder tools/ adds one subcommand, which puts its action here.
using Action = std::function<int()>;

// A whole number within [low, high].
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);

// A number within [low, high].
CLI::Validator number_within(double low, double high);

// One of the given words.
CLI::Validator one_of(const std::vector<std::string>& words);

// --set /json/pointer=value, repeatable; parsed by overrides_of().
void add_set_option(CLI::App& command, std::vector<std::string>& values);
std::vector<scenarios::Override> overrides_of(const std::vector<std::string>& values);

// Defaults are stated in the texts of the options ("Default: ...").
// --format with the first of `formats` as its default.
void add_format_option(CLI::App& command, std::string& format,
                       const std::vector<std::string>& formats);

// Writes the result to standard output. Throws std::runtime_error if that fails (a full disk).
void print_result(const std::string& text);

// Writes "warning: ..." to standard error.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_OPTIONS_H_
