// The elementary functions of cmake/elementary.cmake, as code of the project calls them: right, and
// the same bits wherever the tests run.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/nonempty.h"

namespace simbench {
namespace {

struct Function {
  std::string name;
  double (*value)(double);
  long double (*exact)(long double);  // the system's, with more digits
  double from;
  double to;
  double largest_error_ulp;  // in units of the last place, rounded up
  std::uint64_t digest;      // of the values at the points below
};

#define SIMBENCH_OF(name) \
#name, [](double x) { return std::name(x); }, [](long double x) { return std::name(x); }

const std::vector<Function>& functions() {
  static const std::vector<Function> all = {
      {SIMBENCH_OF(exp), -700, 700, 1, 0x6575d886856e1f40},
      {SIMBENCH_OF(exp2), -1000, 1000, 1, 0x31b0520c570890a6},
      {SIMBENCH_OF(expm1), -3, 3, 1, 0x524d703539cef86},
      {SIMBENCH_OF(log), 0, 100, 1, 0x627fef3b6d7afca5},
      {SIMBENCH_OF(log2), 0, 100, 1, 0x8892755c8f26ac0f},
      {SIMBENCH_OF(log10), 0, 100, 2, 0xf20b57fe006fbddc},
      {SIMBENCH_OF(log1p), -0.9, 10, 1, 0xd5be6996ab5e2fa8},
      {SIMBENCH_OF(sin), -1e6, 1e6, 1, 0x8dd02f203918c0bc},
      {SIMBENCH_OF(cos), -1e6, 1e6, 1, 0x6d6d39baa8198c97},
      {SIMBENCH_OF(tan), -10, 10, 1, 0x803c7d9adab20de4},
      {SIMBENCH_OF(asin), -1, 1, 1, 0x1eeb7f2318bc7ee0},
      {SIMBENCH_OF(acos), -1, 1, 1, 0x7ddb049637771ef1},
      {SIMBENCH_OF(atan), -10, 10, 1, 0x26c1c46daee63176},
      {SIMBENCH_OF(sinh), -30, 30, 2, 0x3ae1e8530c8081f1},
      {SIMBENCH_OF(cosh), -30, 30, 2, 0xade7db59b7a01648},
      {SIMBENCH_OF(tanh), -3, 3, 2, 0x134908943e7a7ab1},
      {SIMBENCH_OF(asinh), -30, 30, 2, 0x3bef2d01e7f6e162},
      {SIMBENCH_OF(acosh), 1, 30, 2, 0x338874439dc89365},
      {SIMBENCH_OF(atanh), -1, 1, 2, 0x6fc99e257af4e2f1},
      {SIMBENCH_OF(erf), -3, 3, 1, 0x1d6149b4d95cfacc},
      {SIMBENCH_OF(erfc), -3, 20, 3, 0x6a69bc6cb475ecb7},
      {SIMBENCH_OF(cbrt), -100, 100, 1, 0x535ef979bacebb0b},
      {"pow", [](double x) { return std::pow(x, 1.75); },
       [](long double x) { return std::pow(x, 1.75L); }, 0, 1e6, 1, 0xc75c169b97099384},
      {"pow of 10", [](double x) { return std::pow(10.0, x); },
       [](long double x) { return std::pow(10.0L, x); }, -300, 300, 1, 0x93d9aa33d04fe8a8},
      {"atan2", [](double x) { return std::atan2(x, -1.25); },
       [](long double x) { return std::atan2(x, -1.25L); }, -10, 10, 2, 0xf4ab21be3ffe1b46},
      {"hypot", [](double x) { return std::hypot(x, 3.25); },
       [](long double x) { return std::hypot(x, 3.25L); }, -30, 30, 1, 0x1f0b628d2da2ff90},
  };
  return all;
}
#undef SIMBENCH_OF

// The same points everywhere: the standard states the generator's words.
std::vector<double> points(const Function& function) {
  std::mt19937_64 words(1);
  std::vector<double> all(20000);
  for (double& x : all) {
    x = function.from +
        (function.to - function.from) * (static_cast<double>(words() >> 11) * 0x1p-53);
  }
  return all;
}

double ulp_of(double value) {
  const double magnitude = std::abs(value);
  return std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
}

TEST(Elementary, FunctionsAreRightToAFewUnitsOfTheLastPlace) {
  for (const Function& function : nonempty(functions())) {
    double largest_ulp = 0;
    for (const double x : points(function)) {
      const double value = function.value(x);
      const long double exact = function.exact(x);
      const double error = std::abs(static_cast<double>(static_cast<long double>(value) - exact));
      largest_ulp = std::max(largest_ulp, error / ulp_of(static_cast<double>(exact)));
    }
    EXPECT_LE(largest_ulp, function.largest_error_ulp) << function.name;
    EXPECT_GT(largest_ulp, 0.4) << function.name << ": compared with itself?";
  }
}

TEST(Elementary, FunctionsGiveTheSameBitsEverywhere) {
  for (const Function& function : nonempty(functions())) {
    std::uint64_t hash = 0xCBF29CE484222325;  // FNV-1a, of whole values
    for (const double x : points(function)) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(function.value(x))) * 0x100000001B3;
    }
    EXPECT_EQ(hash, function.digest) << function.name << ": 0x" << std::hex << hash;
  }
}

// A compiler that computes a constant itself rounds it rightly. These functions do so nearly
// always; each of these constants is one where they do not.
#define SIMBENCH_EXPECT_COMPUTED(name, constant)                                          \
  {                                                                                       \
    const volatile double variable = constant;                                            \
    EXPECT_EQ(std::name(constant), std::name(variable)) << #name;                         \
    EXPECT_NE(std::name(constant), static_cast<double>(std::name(constant##L))) << #name; \
  }
TEST(Elementary, ConstantsAreComputedAsVariablesAre) {
  SIMBENCH_EXPECT_COMPUTED(exp, 3.625)
  SIMBENCH_EXPECT_COMPUTED(log, 12.75)
  SIMBENCH_EXPECT_COMPUTED(log10, 0.75)
  SIMBENCH_EXPECT_COMPUTED(sin, 2.5)
  SIMBENCH_EXPECT_COMPUTED(cos, 0.875)
  SIMBENCH_EXPECT_COMPUTED(tan, 1.875)
  SIMBENCH_EXPECT_COMPUTED(atan, 0.375)
  SIMBENCH_EXPECT_COMPUTED(cbrt, 1.625)
}
#undef SIMBENCH_EXPECT_COMPUTED

}  // namespace
}  // namespace simbench
