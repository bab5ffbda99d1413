// Columns of numbers: read back by a decoder that is written from the description alone.
#include <gmock/gmock.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "reports/page/html_page.h"
#include "reports/text/json_node.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

std::vector<double> three_bytes(const Json& column) {
  const std::string bytes = from_base64(column["u24"]);
  std::vector<double> values;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned k = 0;
    for (std::size_t b = 0; b < 3; ++b) k |= static_cast<unsigned char>(bytes[i + b]) << 8 * b;
    values.push_back(
        k == 0xffffff ? kNaN : column["min"].get<double>() + k * column["unit"].get<double>());
  }
  return values;
}

std::vector<double> decoded(const Json& column) {
  std::vector<double> values;
  if (column.contains("step")) {
    for (std::size_t i = 0; i < column["n"]; ++i) {
      values.push_back(column["from"].get<double>() +
                       static_cast<double>(i) * column["step"].get<double>());
    }
    return values;
  }
  if (column.contains("u24")) return three_bytes(column);
  const std::string bytes = from_base64(column["f64"]);
  values.resize(bytes.size() / 8);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

Json encoded(const std::vector<double>& values, bool relative = false) {
  HtmlColumns columns;
  EXPECT_EQ(columns.add(values, relative), 0U);
  // As it is read: from text.
  return Json::parse(columns.json().dump())[0];
}

void expect_within(const std::vector<double>& values, const std::vector<double>& found,
                   double error) {
  ASSERT_EQ(found.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      EXPECT_TRUE(std::isnan(found[i])) << "at " << i;
    } else {
      EXPECT_LE(std::abs(found[i] - values[i]), error) << "at " << i;
    }
  }
}

TEST(Base64, IsThatOfRfc4648) {
  const std::array<std::pair<const char*, const char*>, 7> vectors = {{{"", ""},
                                                                       {"f", "Zg=="},
                                                                       {"fo", "Zm8="},
                                                                       {"foo", "Zm9v"},
                                                                       {"foob", "Zm9vYg=="},
                                                                       {"fooba", "Zm9vYmE="},
                                                                       {"foobar", "Zm9vYmFy"}}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xfb\xff\xfe"), "+//+");
}

TEST(HtmlColumns, EqualStepsAreThreeNumbers) {
  const std::vector<double> pulses = {225, 226, 227, 228};
  const Json column = encoded(pulses);
  EXPECT_EQ(column, (Json{{"n", 4}, {"from", 225.0}, {"step", 1.0}}));
  EXPECT_EQ(decoded(column), pulses);
  EXPECT_EQ(decoded(encoded({7, 7, 7})), (std::vector<double>{7, 7, 7}));
}

TEST(HtmlColumns, WholeNumbersAreExact) {
  const std::vector<double> near = {-3, 16'000'000, 0, 5};
  EXPECT_TRUE(encoded(near).contains("u24"));
  EXPECT_EQ(decoded(encoded(near)), near);
  const std::vector<double> far = {0, 16'777'217, 9'007'199'254'740'991};
  EXPECT_TRUE(encoded(far).contains("f64"));
  EXPECT_EQ(decoded(encoded(far)), far);
}

TEST(HtmlColumns, GapsStayGaps) {
  const double infinity = std::numeric_limits<double>::infinity();
  expect_within({kNaN, 1, 2.5, kNaN}, decoded(encoded({kNaN, 1, 2.5, infinity})), 1e-6);
  expect_within({kNaN, kNaN}, decoded(encoded({kNaN, kNaN})), 0);
}

TEST(HtmlColumns, LogarithmicAxesKeepEveryValueExactly) {
  const std::vector<double> values = {1e-12, 3e-9, 7e-6, 1};
  EXPECT_EQ(decoded(encoded(values, true)), values);
}

TEST(HtmlColumns, AnyRangeIsTaken) {
  EXPECT_TRUE(decoded(encoded({})).empty());
  EXPECT_EQ(decoded(encoded({0.125})), (std::vector<double>{0.125}));
  const std::vector<double> huge = {-1.7e308, 0.5, 1.7e308};
  EXPECT_EQ(decoded(encoded(huge)), huge);
  const std::vector<double> tiny = {0, 5e-324, 1e-323, 3e-323};
  expect_within(tiny, decoded(encoded(tiny)), 0);
}

TEST(HtmlColumns, EqualColumnsAreStoredOnce) {
  HtmlColumns columns;
  EXPECT_EQ(columns.add({1, 2.5, 3}, false), 0U);
  EXPECT_EQ(columns.add({1, 2.5, 4}, false), 1U);
  EXPECT_EQ(columns.add({1, 2.5, 3}, false), 0U);
  EXPECT_EQ(columns.json().size(), 2U);
}

TEST(HtmlColumns, AreExactToAMillionthOfTheRange) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    boost::random::mt19937 engine(seed);
    boost::random::uniform_real_distribution<double> exponent(-9, 9);
    boost::random::uniform_real_distribution<double> part(0, 1);
    const double base = std::pow(10, exponent(engine));
    const double range = std::pow(10, exponent(engine));
    std::vector<double> values = {base, base + range};
    for (int i = 0; i < 200; ++i) values.push_back(base + range * part(engine));
    // Beside the step, what a double of that size can tell.
    expect_within(values, decoded(encoded(values)), range * 3.1e-8 + base * 1e-15);
  }
}

}  // namespace
}  // namespace simbench::reports
