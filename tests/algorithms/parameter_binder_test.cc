#include "algorithms/parameter_binder.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace simbench {
namespace {

using ::testing::ElementsAre;

enum class Mode { kSlow, kFast };

struct Settings {
  std::size_t points = 16;
  Nanoseconds window = from_ms(0.085);
  Nanoseconds service = from_seconds(7200);
  Nanoseconds interval = from_seconds(1.0 / 16);
  Mode mode = Mode::kFast;
  bool is_quiet = true;
  double step_s = 0.128;
  Nanoseconds other{7};  // no parameter

  void bind(ParameterBinder& parameters) {
    parameters.number("points", points, 1, 100, "of the fit", "a book");
    parameters.number("window_ms", window, 0, 10, "", "");
    parameters.number("service_hours", service, 0, 10, "", "").not_below("window_ms");
    parameters.log2_seconds("log_interval", interval, -7, 12, "", "");
    parameters.choice("mode", mode, {{"slow", Mode::kSlow}, {"fast", Mode::kFast}}, "", "");
    parameters.flag("quiet", is_quiet, "", "");
    parameters.scaled("step_ms", step_s, 1e-3, 0, 1e6, "", "");
  }
};

// The defaults are exactly the decimals that the initialisers say, whatever the units.
TEST(ParameterBinder, ListsTheMembersAsParametersInOrder) {
  const std::vector<ParameterSpec> specs = specs_of(Settings{});
  std::vector<std::string> listed;
  for (const ParameterSpec& spec : specs) listed.push_back(spec.name);
  EXPECT_THAT(listed, ElementsAre("points", "window_ms", "service_hours", "log_interval", "mode",
                                  "quiet", "step_ms"));
  const Parameters defaults = check_parameters(specs, {});
  EXPECT_EQ(defaults.number("points"), 16);
  EXPECT_EQ(defaults.number("window_ms"), 0.085);
  EXPECT_EQ(defaults.number("service_hours"), 2);
  EXPECT_EQ(defaults.number("log_interval"), -4);
  EXPECT_EQ(defaults.text("mode"), "fast");
  EXPECT_TRUE(defaults.flag("quiet"));
  EXPECT_EQ(defaults.number("step_ms"), 128);
  EXPECT_EQ(specs[0].low, 1);
  EXPECT_EQ(specs[0].high, 100);
  EXPECT_EQ(specs[0].meaning, "of the fit");
  EXPECT_EQ(specs[0].source, "a book");
  EXPECT_EQ(specs[2].not_below, "window_ms");
  EXPECT_THAT(specs[4].choices, ElementsAre("slow", "fast"));
}

TEST(ParameterBinder, ReadsTheMembersAndLeavesTheOthers) {
  const std::vector<ParameterSpec> specs = specs_of(Settings{});
  const Parameters given = check_parameters(specs, {{"points", 3.9},
                                                    {"window_ms", 2.5},
                                                    {"service_hours", 3.0},
                                                    {"log_interval", 1.0},
                                                    {"mode", "slow"},
                                                    {"quiet", false},
                                                    {"step_ms", 250.0}});
  const auto settings = settings_from<Settings>(given, {.other = Nanoseconds(9)});
  EXPECT_EQ(settings.points, 3U);
  EXPECT_EQ(settings.window, from_us(2500));
  EXPECT_EQ(settings.service, from_seconds(3 * 3600));
  EXPECT_EQ(settings.interval, from_seconds(2));
  EXPECT_EQ(settings.mode, Mode::kSlow);
  EXPECT_FALSE(settings.is_quiet);
  EXPECT_EQ(settings.step_s, 0.25);
  EXPECT_EQ(settings.other, Nanoseconds(9));
}

TEST(ParameterBinder, EachFormsDefaultsAreItsOwn) {
  const Parameters form =
      check_parameters(specs_of(Settings{.points = 8, .mode = Mode::kSlow}), {});
  EXPECT_EQ(form.number("points"), 8);
  EXPECT_EQ(form.text("mode"), "slow");
}

TEST(ParameterBinderDeathTest, ADefaultIsInItsRangeAndReadsAsItself) {
  EXPECT_DEATH(specs_of(Settings{.points = 0}), "out of its range");
  EXPECT_DEATH(specs_of(Settings{.step_s = 0.009}), "another value");
}

TEST(ParameterBinderDeathTest, ASpanOfTimeHasItsUnitInItsName) {
  struct Unnamed {
    Nanoseconds span{1};
    void bind(ParameterBinder& parameters) { parameters.number("span", span, 0, 1, "", ""); }
  };
  EXPECT_DEATH(specs_of(Unnamed{}), "unit in its name");
}

}  // namespace
}  // namespace simbench
