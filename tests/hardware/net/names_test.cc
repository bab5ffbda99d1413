#include "hardware/net/names.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/hardware/net/in_time.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::address;
using boost::asio::ip::make_address;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<address> found(Task<std::vector<address>> (*search)(boost::asio::any_io_executor,
                                                                std::string, MonotonicTime),
                           const std::string& name) {
  boost::asio::io_context context;
  return Running<std::vector<address>>(context, search(context.get_executor(), name, soon())).get();
}

std::string name_error(Task<std::vector<address>> (*search)(boost::asio::any_io_executor,
                                                            std::string, MonotonicTime),
                       const std::string& name) {
  try {
    found(search, name);
  } catch (const StreamError& error) {
    EXPECT_EQ(error.kind(), StreamError::Kind::kUnreachable);
    return error.what();
  }
  return "none";
}

TEST(NamesTest, EachAddressThatGetentPrintsCountsOnce) {
  EXPECT_THAT(addresses_in("10.0.0.3        STREAM pi.local\n10.0.0.3        DGRAM  \n"
                           "10.0.0.3        RAW    \nfe80::3\tSTREAM\n"),
              ElementsAre(make_address("10.0.0.3"), make_address("fe80::3")));
  EXPECT_THAT(addresses_in(""), IsEmpty());
  EXPECT_THAT(addresses_in("\n\nUnknown database\n 10.0.0.3\n10.0.0\n"), IsEmpty());
}

TEST(NamesTest, GetentFindsWhatLibcFinds) {
  for (const auto search : {&addresses_of, &addresses_by_getent}) {
    const auto addresses = found(search, "localhost");
    EXPECT_TRUE(
        std::ranges::any_of(addresses, [](const auto& each) { return each.is_loopback(); }));
    EXPECT_THAT(name_error(search, "no-such-host.invalid"),
                HasSubstr("no-such-host.invalid: found no such name"));
  }
}

TEST(NamesTest, NumbersAreThemselves) {
  EXPECT_THAT(found(&addresses_of, "192.0.2.7"), ElementsAre(make_address("192.0.2.7")));
  EXPECT_THAT(found(&addresses_of, "::1"), ElementsAre(make_address("::1")));
}

TEST(NamesTest, NoNameIsAnOptionOfGetent) {
  EXPECT_EQ(name_error(&addresses_by_getent, "--help"), "--help: found no such name");
  EXPECT_EQ(name_error(&addresses_by_getent, ""), ": found no such name");
}

TEST(NamesTest, WithoutGetentTheMessageSaysWhatWouldWork) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const std::string error = name_error(&addresses_by_getent, "pi.local");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(error, "pi.local: found no program getent, which finds names; write its address");
}

}  // namespace
}  // namespace simbench::hardware
