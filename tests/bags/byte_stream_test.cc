#include "recording/byte_stream.h"

#include <gmock/gmock.h>

#include <random>

#include "tests/bags/bag_writers.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

const std::vector<std::pair<Compression, std::string>> kCompressions = {
    {Compression::kLz4, "lz4"},
    {Compression::kZstd, "zstd"},
    {Compression::kBzip2, "bz2"},
    {Compression::kGzip, "gzip"}};

std::string mixed_text(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::string text(size, '\0');
  for (char& letter : text) letter = static_cast<char>(random() % 4 == 0 ? random() : 'a');
  return text;
}

std::string all_of(ByteStream& stream, std::size_t step) {
  std::string all;
  std::string part(step, '\0');
  while (const std::size_t size = stream.read(part.data(), step)) all.append(part, 0, size);
  return all;
}

TEST(ByteStream, InflatesWhatWasDeflatedInStepsOfAnySize) {
  const std::string plain = mixed_text(300'000, 7);
  for (const auto& [compression, name] : kCompressions) {
    const std::string packed = deflated(name, plain);
    for (const std::size_t step : {1U, 13U, 65536U, 1'000'000U}) {
      MemoryBytes bytes(packed);
      EXPECT_EQ(all_of(*inflated(compression, bytes), step), plain) << name << " " << step;
    }
  }
}

TEST(ByteStream, SkipsToAnyPlaceAndNotBeyondTheEnd) {
  const std::string plain = mixed_text(100'000, 8);
  for (const auto& [compression, name] : kCompressions) {
    const std::string packed = deflated(name, plain);
    for (const std::size_t place : {0U, 1U, 65'535U, 65'536U, 99'999U}) {
      MemoryBytes bytes(packed);
      const auto stream = inflated(compression, bytes);
      EXPECT_EQ(stream->skip(place), place);
      char letter = 0;
      EXPECT_EQ(stream->read(&letter, 1), 1U);
      EXPECT_EQ(letter, plain[place]) << name << " " << place;
      EXPECT_EQ(stream->skip(plain.size()), plain.size() - place - 1);
      EXPECT_EQ(stream->read(&letter, 1), 0U);
    }
  }
}

TEST(ByteStream, SeveralFramesAreOneStream) {
  for (const auto& [compression, name] : kCompressions) {
    if (compression == Compression::kBzip2) continue;
    const std::string packed = deflated(name, "one,") + deflated(name, "two");
    MemoryBytes bytes(packed);
    EXPECT_EQ(all_of(*inflated(compression, bytes), 100), "one,two") << name;
  }
}

TEST(ByteStream, EveryCutIsAnErrorAndGivesTheBeginning) {
  const std::string plain = mixed_text(3000, 9);
  for (const auto& [compression, name] : kCompressions) {
    const std::string packed = deflated(name, plain);
    for (std::size_t cut = 1; cut < packed.size(); ++cut) {
      MemoryBytes bytes(std::string_view(packed).substr(0, cut));
      const auto stream = inflated(compression, bytes);
      std::string got;
      char letter = 0;
      try {
        while (stream->read(&letter, 1) == 1) got += letter;
        ADD_FAILURE() << name << ": no error at " << cut;
      } catch (const InflateError&) {
        EXPECT_TRUE(plain.starts_with(got)) << name << " " << cut;
      }
    }
  }
}

TEST(ByteStream, EveryFlippedByteEndsInAnErrorOrInBytes) {
  const std::string plain = mixed_text(500, 10);
  for (const auto& [compression, name] : kCompressions) {
    const std::string packed = deflated(name, plain);
    std::size_t errors = 0;
    for (std::size_t i = 0; i < packed.size(); ++i) {
      std::string damaged = packed;
      damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
      MemoryBytes bytes(damaged);
      try {
        EXPECT_LT(all_of(*inflated(compression, bytes), 4096).size(), 10'000'000U) << name << i;
      } catch (const InflateError&) {
        ++errors;
      }
    }
    EXPECT_GT(errors, 0U) << name;
  }
}

TEST(ByteStream, AFileIsReadSkippedAndSought) {
  const ScratchFolder folder;
  const std::string text = mixed_text(100'000, 11);
  FileBytes file(folder.write("file", text));
  std::mt19937 random(12);
  std::uint64_t place = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t count = random() % 40'000;
    if (random() % 3 == 0) {
      place = random() % (text.size() + 10);
      file.seek(place);
    } else if (random() % 2 == 0) {
      const std::uint64_t left = place < text.size() ? text.size() - place : 0;
      EXPECT_EQ(file.skip(count), std::min(count, left)) << "seed 12, step " << i;
      place += std::min(count, left);
    } else {
      std::string got(count, '\0');
      const std::size_t size = file.read(got.data(), count);
      got.resize(size);
      const std::string expected = place < text.size() ? text.substr(place, size) : "";
      ASSERT_EQ(got, expected) << "seed 12, step " << i;
      place += size;
    }
    ASSERT_EQ(file.position(), place) << "seed 12, step " << i;
  }
}

TEST(ByteStream, ALimitEndsBeforeTheRest) {
  MemoryBytes bytes("abcdef");
  LimitedBytes part(bytes, 4);
  char two[2];
  EXPECT_TRUE(part.read_exactly(two, 2));
  EXPECT_EQ(part.skip(9), 2U);
  EXPECT_FALSE(part.read_exactly(two, 1));
  EXPECT_TRUE(bytes.read_exactly(two, 2));
  EXPECT_EQ(std::string_view(two, 2), "ef");
}

}  // namespace
}  // namespace simbench::bags
