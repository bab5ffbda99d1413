#include "tests/robustness/mutation.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace simbench::robustness {
namespace {

struct Part {
  std::size_t begin = 0;
  std::size_t size = 0;
};

Part random_part(const std::string& text, Random& random) {
  if (text.empty()) return {};
  const std::size_t begin = random.below(text.size());
  const std::size_t longest = std::min<std::size_t>(text.size() - begin, 400);
  return {begin, 1 + random.below(longest)};
}

// The line around a random place, with its end.
Part random_line(const std::string& text, Random& random) {
  if (text.empty()) return {};
  const std::size_t at = random.below(text.size());
  const std::size_t before = text.rfind('\n', at == 0 ? 0 : at - 1);
  const std::size_t begin = at == 0 || before == std::string::npos ? 0 : before + 1;
  const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
  return {begin, end + 1 > begin ? end + 1 - begin : 0};
}

// The number or word at a random place, or the next one.
Part random_word(const std::string& text, Random& random) {
  if (text.empty()) return {};
  const auto is_word = [&](std::size_t at) {
    const auto c = static_cast<unsigned char>(text[at]);
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_' || c == '+';
  };
  std::size_t begin = random.below(text.size());
  while (begin < text.size() && !is_word(begin)) ++begin;
  while (begin > 0 && begin < text.size() && is_word(begin - 1)) --begin;
  std::size_t end = begin;
  while (end < text.size() && is_word(end)) ++end;
  return {begin, end - begin};
}

// A part that a change is about: anywhere, or a whole line.
Part random_piece(const std::string& text, Random& random) {
  return random.one_in(2) ? random_part(text, random) : random_line(text, random);
}

void change_once(std::string& text, Random& random) {
  switch (random.below(9)) {
    case 0:
      if (!text.empty()) text[random.below(text.size())] = static_cast<char>(random.below(256));
      return;
    case 1:
    case 2: {
      const Part piece = random_piece(text, random);
      text.erase(piece.begin, piece.size);
      return;
    }
    case 3:
    case 4: {
      const Part piece = random_piece(text, random);
      text.insert(random.below(text.size() + 1), text.substr(piece.begin, piece.size));
      return;
    }
    case 5:
      text.resize(random.below(text.size() + 1));
      return;
    case 6:
      text.insert(random.below(text.size() + 1), hostile_word(random));
      return;
    default: {
      const Part word = random_word(text, random);
      text.replace(word.begin, word.size, hostile_word(random));
      return;
    }
  }
}

}  // namespace

std::string hostile_word(Random& random) {
  using namespace std::string_literals;
  static const std::vector<std::string> words = {"0",
                                                 "-0",
                                                 "-1",
                                                 "1",
                                                 "2",
                                                 "1e308",
                                                 "-1e308",
                                                 "1e-308",
                                                 "1e999",
                                                 "0.5",
                                                 "-0.0001",
                                                 "127",
                                                 "255",
                                                 "256",
                                                 "65536",
                                                 "1000000",
                                                 "1000001",
                                                 "2147483647",
                                                 "2147483648",
                                                 "4294967295",
                                                 "4294967296",
                                                 "9007199254740993",
                                                 "9223372036854775807",
                                                 "-9223372036854775808",
                                                 "18446744073709551615",
                                                 "18446744073709551616",
                                                 "1e15",
                                                 "00012",
                                                 "0x10",
                                                 "1,5",
                                                 "NaN",
                                                 "Infinity",
                                                 "-Infinity",
                                                 "nan",
                                                 "inf",
                                                 "null",
                                                 "true",
                                                 "false",
                                                 "",
                                                 " ",
                                                 "\t",
                                                 "\r\n",
                                                 "\n",
                                                 ",",
                                                 ",,,,",
                                                 ":",
                                                 "/",
                                                 "..",
                                                 "../..",
                                                 "~",
                                                 "{}",
                                                 "[]",
                                                 "[",
                                                 "}",
                                                 "\"",
                                                 "\"\"",
                                                 "'",
                                                 "\\",
                                                 "\\u0000",
                                                 "\\ud800",
                                                 "\0"s,
                                                 "\x1b[31m",
                                                 "\xff\xfe",
                                                 "\xc3\x28",
                                                 "\xef\xbb\xbf",
                                                 "%s%n",
                                                 "$HOME",
                                                 "#",
                                                 "//",
                                                 "/*"};
  if (random.one_in(40)) return std::string(1 + random.below(200'000), 'A');
  if (random.one_in(40))
    return std::string(1 + random.below(200'000), random.one_in(2) ? '[' : '9');
  return random.of(words);
}

std::string mutated(std::string text, Random& random) {
  const std::size_t changes = 1 + random.below(4);
  for (std::size_t i = 0; i < changes; ++i) change_once(text, random);
  return text;
}

}  // namespace simbench::robustness
