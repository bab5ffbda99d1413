// Names of a file that anyone may have written, with all that a terminal or a reader would obey: no
// output has any of it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bags/rosbag_writer.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using Words = std::vector<std::string>;

const std::string kHostile =
    "\x1b[2J\x07\x7f\u0080\u0085\u009b31m\u061c\u200e\u200f\u2028\u2029\u202a\u202b\u202c"
    "\u202d\u202e\u2066\u2067\u2068\u2069\ufeff";

// What is obeyed, as bytes: C0 but for line ends and the tabs of gnuplot, DEL, C1, and marks of
// direction and lines.
std::string obeyed_in(std::string_view text) {
  std::string found;
  for (const char byte : text) {
    if ((byte >= 0 && byte < ' ' && byte != '\n' && byte != '\t') || byte == 0x7f) {
      found += fmt::format("{:02x} ", static_cast<unsigned>(byte));
    }
  }
  for (std::size_t at = 0; (at = text.find('\xc2', at)) < text.size(); ++at) {
    if (at + 1 < text.size() && static_cast<unsigned char>(text[at + 1]) < 0xa0) found += "C1 ";
  }
  for (const std::string_view mark :
       {"\u061c", "\u200e", "\u200f", "\u2028", "\u2029", "\u202a", "\u202b", "\u202c", "\u202d",
        "\u202e", "\u2066", "\u2067", "\u2068", "\u2069", "\ufeff"}) {
    if (text.find(mark) != std::string_view::npos) {
      found += fmt::format("{:02x} ", fmt::join(mark, " "));
    }
  }
  return found;
}

class HostileNames : public ProgramTest {
 protected:
  // Runs a command line and checks what it printed and the file that it wrote.
  ProgramResult shows(const Words& words, const std::string& written = {}) const {
    SCOPED_TRACE(obeyed_in(fmt::format("{}", fmt::join(words, " "))).empty()
                     ? fmt::format("{}", fmt::join(words, " "))
                     : words.front() + " of a hostile file name");
    ProgramResult result = run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(obeyed_in(result.out), "");
    EXPECT_EQ(obeyed_in(result.err), "");
    if (!written.empty()) {
      EXPECT_EQ(obeyed_in(content(written)), "");
    }
    return result;
  }

  void shows_everywhere(const Words& inputs) const {
    const auto with = [&](Words words, const Words& more = {}) {
      words.insert(words.end(), inputs.begin(), inputs.end());
      words.insert(words.end(), more.begin(), more.end());
      return words;
    };
    shows(with({"inspect"}));
    EXPECT_TRUE(Json::accept(shows(with({"inspect"}, {"--json"})).out));
    shows(with({"diagnose"}));
    EXPECT_TRUE(Json::accept(shows(with({"diagnose"}, {"--json"})).out));
    shows(with({"diagnose", "--html", "page.html"}));
    shows_page("page.html");
    for (const char* const format : {"table", "markdown", "latex", "csv", "tidy", "json"}) {
      shows(with({"replay", "--pipelines", "hull_300", "--format", format}));
    }
    shows(with({"replay", "--pipelines", "hull_300", "-o", "archive"}), "archive/results.json");
    EXPECT_EQ(obeyed_in(content("archive/manifest.json")), "");
    EXPECT_EQ(obeyed_in(content("archive/frames.csv")), "");
    shows({"report", "archive", "-o", "report.html"});
    shows_page("report.html");
    EXPECT_THAT(shows(with({"export"})).out, HasSubstr("\\xe2\\x80\\xae"));
    shows(with({"export", "--stamps", "hull_300", "-o", "stamps.csv"}), "stamps.csv");
    for (const char* const format : {"table", "json"}) {
      shows(with({"fit", "-o", "model.json", "--format", format}), "model.json");
    }
    shows(with({"figure", "phases"}, {"-o", "p.csv"}), "p.csv");
    shows(with({"figure", "phases"}, {"-o", "p.svg"}), "p.svg");
    shows(with({"figure", "phases"}, {"-o", "p.pdf"}));
  }

  // The page's own scripts have characters of the kind, once for all pages.
  void shows_page(const std::string& name) const {
    std::string page = content(name);
    EXPECT_THAT(page, HasSubstr("\\xe2\\x80\\xae"));
    for (const char* const tag : {"<style>", "<script>"}) {
      const std::string end = std::string("</") + (tag + 1);
      for (std::size_t at = 0; (at = page.find(tag)) != std::string::npos;) {
        page.erase(at, page.find(end, at) - at);
      }
    }
    EXPECT_EQ(obeyed_in(page), "") << name;
  }
};

TEST_F(HostileNames, OfABag) {
  bags::RosbagWriter writer(bags::RosbagWriter::Chunks::kNone);
  Words topics;
  for (const char* const side : {"left", "right"}) {
    topics.push_back("/" + (side + kHostile) + "/image_raw");
    writer.add_topic(topics.back(), "sensor_msgs/Image", "/recorder" + kHostile);
  }
  for (int i = 0; i < 1300; ++i) {
    for (std::uint32_t topic = 0; topic < 2; ++topic) {
      const Nanoseconds at = std::chrono::seconds(1000) + i * std::chrono::nanoseconds(33'333'333);
      const Nanoseconds late = std::chrono::microseconds(9000 + (i + 3 * topic) * 7919 % 97 * 5);
      writer.add_message(topic, at + late,
                         bags::ros1_header(static_cast<std::uint32_t>(i), at, "frame" + kHostile));
    }
  }
  const std::string name = file("rig" + kHostile + ".bag", writer.bag());
  shows_everywhere({name});
  shows_everywhere({name, "--topics", topics[0] + "," + topics[1]});
}

TEST_F(HostileNames, OfACsvAndItsColumns) {
  const std::string columns = fmt::format(
      "stream=kind{0},sensor=stamp{0},arrival=arrived{0},counter=count{0},camera=camera{0}",
      kHostile);
  std::string text = fmt::format("kind{0},stamp{0},arrived{0},count{0},camera{0}\n", kHostile);
  for (int i = 0; i < 1300; ++i) {
    const double ms = i * 1000.0 / 30;
    for (const char* const side : {"left", "right"}) {
      text += fmt::format("Depth{0},{1:.3f},{2:.3f},{3},{4}{0}\n", kHostile, 700 + ms,
                          ms + 9 + i * 7919 % 97 * 0.005, i, side);
    }
  }
  const std::string name = file("rig" + kHostile + ".csv", text);
  shows_everywhere({name, "--columns", columns});
}

TEST_F(HostileNames, OfWhatIsRefused) {
  for (const Words& words : {Words{"inspect", "none" + kHostile}, Words{"diagnose", kHostile},
                             Words{"figure", kHostile, "-o", "x.svg"}, Words{kHostile},
                             Words{"export", "x" + kHostile, "-o", "x" + kHostile + "/y"},
                             Words{"inspect", "--" + kHostile}, Words{"inspect", "x", "--json"}}) {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(obeyed_in(result.out + result.err), "") << words.front();
  }
}

}  // namespace
}  // namespace simbench
