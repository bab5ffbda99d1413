// Choices that have words: an enum and the table of its words, words_of().
//
// Each word stands once, for the loader, descriptions and messages. The enums of a scenario come
// from scenarios/schema.json (scenarios/choices.h); others state their table beside the enum.
// Names of algorithms, pipelines and camera models are open-ended and stay text.
//
//   to_text(SyncMode::kFullSlave);        // "full_slave"
//   from_text<SyncMode>("full_slave");    // SyncMode::kFullSlave
//   from_text<SyncMode>("fullslave");     // nothing
//   all_texts<SyncMode>();                // "default", "master", "slave", "full_slave", "genlock"
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace simbench::scenarios {

template <class Enum>
struct Word {
  Enum value;
  std::string_view text;
};

// An enum with a table of words.
template <class Enum>
concept Choice = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value);
};

template <Choice Enum>
constexpr std::string_view to_text(Enum value) {
  for (const Word<Enum>& word : words_of(value)) {
    if (word.value == value) return word.text;
  }
  return "?";  // no value of the enum
}

// Nothing if `text` is no word of the enum.
template <Choice Enum>
constexpr std::optional<Enum> from_text(std::string_view text) {
  for (const Word<Enum>& word : words_of(Enum{})) {
    if (word.text == text) return word.value;
  }
  return std::nullopt;
}

// In the order of the schema.
template <Choice Enum>
std::vector<std::string> all_texts() {
  std::vector<std::string> texts;
  for (const Word<Enum>& word : words_of(Enum{})) texts.emplace_back(word.text);
  return texts;
}

}  // namespace simbench::scenarios
