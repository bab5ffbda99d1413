#include "reconstruction/libraries/quiet_errors.h"

#include <gtest/gtest.h>

#include <sstream>
#include <thread>

namespace simbench::reconstruction {
namespace {

TEST(QuietErrors, DropsWhatIsWrittenInsideAScopeAndNothingElse) {
  std::ostringstream written;
  std::streambuf* before = std::cerr.rdbuf(written.rdbuf());
  {
    const QuietErrors quiet;
    std::cerr << "one ";
    {
      const QuietErrors::Scope scope;
      std::cerr << "chatter " << 7;
      std::thread([] { std::cerr << "two "; }).join();
    }
    std::cerr << 'x' << std::flush;
  }
  std::cerr << " after";
  std::cerr.rdbuf(before);
  EXPECT_EQ(written.str(), "one two x after");
}

}  // namespace
}  // namespace simbench::reconstruction
