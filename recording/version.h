// Which simbench this is: for --version, for the manifest of a result, for messages that must say
// with which program a seed shows what it shows.
//
// The values are read at build time, into one small source file of their own (cmake/version.cmake).
#ifndef SIMBENCH_RECORDING_VERSION_H_
#define SIMBENCH_RECORDING_VERSION_H_

#include <string_view>

namespace simbench {

// The release, as in "0.1.0".
std::string_view version();

// The commit it was built from, as in "1a2b3c4d5e6f", with "-dirty" when files differed from it;
// "unknown" when the sources were no Git checkout.
std::string_view commit();

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_VERSION_H_
