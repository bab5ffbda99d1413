#include "cli/messages.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace simbench::cli {
namespace {

// An environment variable for one test, given back after it.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    if (value == nullptr) {
      unsetenv(name);
    } else {
      setenv(name, value, 1);
    }
  }
  ~Variable() {
    if (old_) {
      setenv(name_, old_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

TEST(Terminal, ColumnsIsTheWidthIfItIsANumber) {
  for (const int columns : {20, 80, 160, 100000}) {
    const Variable set("COLUMNS", std::to_string(columns).c_str());
    EXPECT_EQ(width_of_output(), static_cast<std::size_t>(columns));
  }
  const Variable unset("COLUMNS", nullptr);
  const auto without = width_of_output();
  for (const char* wrong : {"", "0", "19", "-80", "80x", " 80", "wide"}) {
    const Variable set("COLUMNS", wrong);
    EXPECT_EQ(width_of_output(), without) << wrong;
  }
}

TEST(Terminal, ColourIsRefusedInEitherWay) {
  const Variable no_color("NO_COLOR", nullptr);
  const Variable clicolor("CLICOLOR", nullptr);
  EXPECT_TRUE(wants_colour());
  for (const auto& [name, value, wanted] :
       {std::tuple{"NO_COLOR", "1", false}, std::tuple{"NO_COLOR", "", true},
        std::tuple{"CLICOLOR", "0", false}, std::tuple{"CLICOLOR", "1", true}}) {
    const Variable set(name, value);
    EXPECT_EQ(wants_colour(), wanted) << name << "=" << value;
  }
}

TEST(Terminal, ADumbOneTakesNoEscapes) {
  for (const auto& [value, takes] :
       {std::pair{"dumb", false}, std::pair{"", false}, std::pair{"xterm", true}}) {
    const Variable set("TERM", value);
    EXPECT_EQ(takes_escapes(), takes) << value;
  }
}

}  // namespace
}  // namespace simbench::cli
