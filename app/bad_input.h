// What a user did wrong, among exceptions: the text to show, where others are internal errors.
//
//   try {
//     scenarios::load_scenario("no_such");
//   } catch (const std::exception& error) {
//     if (const auto text = bad_input(error)) fmt::print(stderr, "error: {}\n", *text);
//   }
#pragma once

#include <exception>
#include <optional>
#include <string>

namespace simbench::app {

// The text for input that is refused, files that cannot be read and results that cannot be written;
// nothing for any other exception.
std::optional<std::string> bad_input(const std::exception& error);

}  // namespace simbench::app
