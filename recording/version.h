// The version of simbench: for --version, for the manifest of a result, for messages about a seed.
//
// The values are read at build time into a small source file (cmake/version.cmake).
#pragma once

#include <string>
#include <string_view>

namespace simbench {

// The release, as in "0.1.0".
std::string_view version();

// The commit of the build, as in "1a2b3c4d5e6f", with "-dirty" when files differed from it;
// "unknown" when the sources were no Git checkout.
std::string_view commit();

// What reads a file whose format this program is too old for. `writer`: the version that the file
// states; empty if it states none.
//
//   throw std::runtime_error("found 2, allowed: at most 1; " + advice_on_newer_format("0.3.0"));
std::string advice_on_newer_format(std::string_view writer);

}  // namespace simbench
