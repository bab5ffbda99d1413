#include "recording/text_file.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "recording/line_reader.h"
#include "scenarios/input_file.h"
#include "tests/deflated.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

using testing::HasSubstr;

std::string utf16(const std::u16string& text, bool big_endian, bool mark) {
  std::string bytes;
  for (const char16_t unit : (mark ? u"\ufeff" : u"") + text) {
    const auto high = static_cast<char>(unit >> 8U);
    const auto low = static_cast<char>(unit & 0xffU);
    bytes += big_endian ? high : low;
    bytes += big_endian ? low : high;
  }
  return bytes;
}

class TextFileTest : public testing::Test {
 protected:
  std::string read(const std::string& content, std::size_t step = 4096) {
    TextFile file(folder_.write("a.txt", content));
    std::string all;
    std::vector<char> buffer(step);
    while (const std::size_t size = file.read(buffer.data(), buffer.size())) {
      all.append(buffer.data(), size);
    }
    return all;
  }
  std::string problem(const std::string& content) {
    try {
      read(content);
    } catch (const FileError& error) {
      return error.what();
    }
    return "none";
  }

  ScratchFolder folder_;
};

TEST_F(TextFileTest, InflatesWhatIsCompressed) {
  std::string text;
  for (int i = 0; i < 50'000; ++i) text += std::to_string(i * 7919) + "\n";
  EXPECT_EQ(read(text), text);
  EXPECT_EQ(read(deflated("gzip", text)), text);
  EXPECT_EQ(read(deflated("gzip", text) + deflated("gzip", "more\n")), text + "more\n")
      << "two members";
  EXPECT_EQ(read(deflated("zstd", text)), text);
  EXPECT_EQ(read(deflated("bz2", text)), text);
  EXPECT_EQ(read(deflated("lz4", text)), text);
  EXPECT_EQ(read(deflated("gzip", "")), "");
  EXPECT_EQ(read(""), "");
}

TEST_F(TextFileTest, TurnsUtf16IntoUtf8) {
  const std::u16string text = u"time_s,offset_µs\r\n1,\U0001F600\n";
  const std::string plain = "time_s,offset_µs\r\n1,\U0001F600\n";
  for (const bool big_endian : {false, true}) {
    for (const bool mark : {false, true}) {
      for (const std::size_t step : {4U, 5U, 64U}) {
        EXPECT_EQ(read(utf16(text, big_endian, mark), step), plain) << big_endian << mark << step;
      }
    }
  }
  EXPECT_EQ(read(deflated("gzip", utf16(text, false, true))), plain);
  EXPECT_EQ(read("\xef\xbb\xbf"
                 "abcd"),
            "abcd");
  const std::string halves =
      utf16(std::u16string(u"ab") + static_cast<char16_t>(0xd83d) + u"c", false, true);
  EXPECT_EQ(read(halves),
            "ab\xef\xbf\xbd"
            "c");
}

TEST_F(TextFileTest, DamageIsAnError) {
  const std::string packed = deflated("gzip", std::string(100'000, 'a') + "\n");
  EXPECT_EQ(problem(packed.substr(0, packed.size() / 2)),
            "gzip: the compressed bytes end too early");
  std::string broken = packed;
  broken[20] = static_cast<char>(broken[20] ^ 0x55);
  EXPECT_THAT(problem(broken), HasSubstr("gzip: the compressed bytes"));
}

TEST_F(TextFileTest, ASmallFileDoesNotBecomeAnyAmountOfText) {
  const std::string bomb = deflated("gzip", std::string(std::size_t{80} << 20, 'a'));
  EXPECT_LT(bomb.size(), 100'000U);
  EXPECT_THAT(problem(bomb), HasSubstr("more than 128 times as long when inflated; unpack it"));
  LineReader lines(folder_.write("c.gz", deflated("gzip", std::string(5'000'000, '\n'))));
  try {
    while (lines.next()) continue;
    FAIL() << "5 million lines of 5 kB";
  } catch (const LineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("more lines than a file of its size may have"));
  }
}

TEST_F(TextFileTest, OtherFilesAreNamed) {
  EXPECT_EQ(problem("\x1a\x45\xdf\xa3 matroska"), "it is a Matroska file, no text");
  EXPECT_EQ(problem("\x89HDF\r\n\x1a\n"), "it is an HDF5 file, no text");
  EXPECT_EQ(problem(std::string("\0\0\0\x20"
                                "ftypisom",
                                12)),
            "it is an MP4 file, no text");
  EXPECT_EQ(problem("#ROSBAG V2.0\n"), "it is a rosbag 2.0 bag, no text");
  EXPECT_EQ(
      problem("\x93NUMPY v"),
      "it is a NumPy array, no text; simbench.write_recording() of the Python package makes a "
      "CSV of it");
}

TEST_F(TextFileTest, LinesMayBeReadAgain) {
  std::string text;
  for (int i = 0; i < 30'000; ++i) text += std::to_string(i) + "\n";
  LineReader lines(folder_.write("b.txt", text + "torn"));
  EXPECT_EQ(lines.next(), "0");
  lines.mark();
  for (int i = 1; i < 20'000; ++i) ASSERT_EQ(lines.next(), std::to_string(i));
  EXPECT_EQ(lines.line(), 20'000U);
  lines.rewind();
  for (int i = 1; i < 30'000; ++i) ASSERT_EQ(lines.next(), std::to_string(i));
  EXPECT_FALSE(lines.torn());
  EXPECT_EQ(lines.next(), std::nullopt);
  EXPECT_TRUE(lines.torn());
  EXPECT_EQ(lines.line(), 30'001U);
}

}  // namespace
}  // namespace simbench
