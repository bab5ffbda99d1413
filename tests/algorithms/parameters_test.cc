#include "algorithms/parameters.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <vector>

#include "algorithms/parameter_binder.h"

namespace simbench {
namespace {

using ::testing::HasSubstr;

const std::vector<ParameterSpec> kSpecs = {
    {.name = "stamps",
     .fallback = 100.0,
     .low = 1,
     .high = 1e6,
     .choices = {},
     .meaning = "n_d",
     .source = "test"},
    {.name = "delay",
     .fallback = std::string("literal"),
     .choices = {"literal", "intended"},
     .meaning = "reading of t_l",
     .source = "test"},
    {.name = "quiet", .fallback = false, .choices = {}, .meaning = "", .source = "test"},
};

// Any number is a number, whatever its type; what is neither true nor false nor a number is a text.
TEST(ParameterSpecs, DefaultsAreWrittenAsTheyAreMeant) {
  const std::vector<ParameterSpec> specs = {
      {.name = "points",
       .fallback = 16,
       .low = 1,
       .high = 100,
       .choices = {},
       .meaning = "",
       .source = ""},
      {.name = "ratio",
       .fallback = 0.5F,
       .low = 0,
       .high = 1,
       .choices = {},
       .meaning = "",
       .source = ""},
      {.name = "mode",
       .fallback = "slow",
       .choices = {"slow", "fast"},
       .meaning = "",
       .source = ""},
      {.name = "quiet", .fallback = true, .choices = {}, .meaning = "", .source = ""}};
  const Parameters parameters = check_parameters(specs, {});
  EXPECT_EQ(parameters.number("points"), 16);
  EXPECT_EQ(parameters.number("ratio"), 0.5);
  EXPECT_EQ(parameters.text("mode"), "slow");
  EXPECT_TRUE(parameters.flag("quiet"));
}

// The message of the refusal; checks which parameter it names.
std::string refusal(const std::string& name, const ParameterValue& value) {
  try {
    check_parameters(kSpecs, {{name, value}});
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.parameter(), name);
    return error.what();
  }
  ADD_FAILURE() << name << " was accepted";
  return "";
}

TEST(Parameters, DefaultsWhereNothingIsGiven) {
  const Parameters parameters = check_parameters(kSpecs, {});
  EXPECT_EQ(parameters.number("stamps"), 100.0);
  EXPECT_EQ(parameters.text("delay"), "literal");
  EXPECT_FALSE(parameters.flag("quiet"));
  EXPECT_EQ(parameters.all().size(), 3U);
}

TEST(Parameters, GivenValuesReplaceDefaults) {
  const Parameters parameters =
      check_parameters(kSpecs, {{"stamps", 1.0}, {"delay", "intended"}, {"quiet", true}});
  EXPECT_EQ(parameters.number("stamps"), 1.0);
  EXPECT_EQ(parameters.text("delay"), "intended");
  EXPECT_TRUE(parameters.flag("quiet"));
  EXPECT_EQ(check_parameters(kSpecs, {{"stamps", 1e6}}).number("stamps"), 1e6);
}

TEST(Parameters, RefusesUnknownNames) {
  const std::string message = refusal("stemps", 3.0);
  EXPECT_THAT(message, HasSubstr("\"stemps\""));
  EXPECT_THAT(message, HasSubstr("\"stamps\", \"delay\", \"quiet\""));
  try {
    check_parameters({}, {{"stamps", 1.0}});
    FAIL() << "an algorithm without parameters took one";
  } catch (const ParameterError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has none"));
  }
}

TEST(Parameters, RefusesNumbersOutOfRange) {
  EXPECT_EQ(refusal("stamps", 0.5),
            "parameter \"stamps\" is 0.5; allowed: a number from 1 to 1e+06");
  refusal("stamps", 1000001.0);
  refusal("stamps", std::numeric_limits<double>::quiet_NaN());
  refusal("stamps", std::numeric_limits<double>::infinity());
}

TEST(Parameters, RefusesOtherTypes) {
  EXPECT_EQ(refusal("stamps", true),
            "parameter \"stamps\" is true; allowed: a number from 1 to 1e+06");
  EXPECT_EQ(refusal("delay", 1.0),
            "parameter \"delay\" is 1; allowed: one of \"literal\", \"intended\"");
  EXPECT_EQ(refusal("quiet", "yes"), "parameter \"quiet\" is \"yes\"; allowed: true or false");
}

TEST(Parameters, RefusesOtherChoices) {
  EXPECT_EQ(refusal("delay", "Literal"),
            "parameter \"delay\" is \"Literal\"; allowed: one of \"literal\", \"intended\"");
}

TEST(ParametersDeathTest, AskingForWhatWasNotDeclaredIsABug) {
  const Parameters parameters = check_parameters(kSpecs, {});
  EXPECT_DEATH(parameters.number("threshold_ms"), "did not declare");
}

TEST(Parameters, RefusesThoseThatContradictEachOther) {
  struct Bounds {
    int least = 6;
    int most = 10;
    void bind(ParameterBinder& parameters) {
      parameters.number("least", least, 0, 17, "", "test");
      parameters.number("most", most, 0, 17, "", "test").not_below("least");
    }
  };
  const std::vector<ParameterSpec> specs = specs_of(Bounds{});
  const auto problem = [&](const ParameterValues& given, const std::string& blamed) {
    try {
      check_parameters(specs, given);
    } catch (const ParameterError& error) {
      EXPECT_EQ(error.parameter(), blamed);
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(problem({{"most", 5.0}}, "most"),
            "parameter \"most\" is 5; allowed: at least \"least\", which is 6");
  EXPECT_EQ(problem({{"least", 12.0}}, "least"),
            "parameter \"least\" is 12; allowed: at most \"most\", which is 10");
  EXPECT_EQ(problem({{"least", 12.0}, {"most", 11.0}}, "most"),
            "parameter \"most\" is 11; allowed: at least \"least\", which is 12");
  EXPECT_EQ(problem({{"least", 3.0}, {"most", 3.0}}, ""), "none");
}

}  // namespace
}  // namespace simbench
