// JSON text with the position of every value, so that messages can name the line.
//
// Stricter than JSON where leniency would hide a mistake: a key may stand only once in an object,
// and nesting is limited to kMaximumNesting, which also bounds the recursion of later walks over
// the document. A byte order mark is skipped. Whole numbers are std::int64_t however they are
// written (480, 480.0, 4.8e2), all others double.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scenarios/loader.h"

namespace simbench::scenarios {

inline constexpr std::size_t kMaximumNesting = 64;

struct JsonDocument {
  nlohmann::json root;
  std::map<std::string, std::size_t> lines;  // by JSON pointer: of the key, of the array element
};

// Text that is no acceptable JSON; what() is the reason in plain words.
class DocumentError : public std::runtime_error {
 public:
  DocumentError(const std::string& problem, bool is_syntax, std::size_t line, std::size_t column)
      : std::runtime_error(problem), is_syntax_(is_syntax), line_(line), column_(column) {}
  bool is_syntax() const { return is_syntax_; }  // else: JSON, but beyond the limits above
  std::size_t line() const { return line_; }     // both count from 1
  std::size_t column() const { return column_; }

 private:
  bool is_syntax_;
  std::size_t line_;
  std::size_t column_;
};

// Throws DocumentError. Linear in the size of the text.
JsonDocument parse_document(std::string_view text);

// "/parent" and "a/b" -> "/parent/a~1b" (RFC 6901).
std::string child_pointer(const std::string& parent, std::string_view key);

// Whether the text is UTF-8, as all text in JSON must be.
bool is_utf8(const std::string& text);

// The source of a value: a file and line, or a --set.
struct Place {
  std::string label{};           // "FILE:LINE" or "--set /pointer=value"
  std::string set_pointer{};     // of a --set: the pointer it names
  std::string profile_source{};  // of a value that an oscillator's class gives: the profile's
  bool is_set = false;
  bool is_builtin = false;  // a file of the distribution
  std::size_t level = 0;    // later sources have higher levels
  std::size_t line = 0;
};

// Kept beside the JSON value while files and overrides are merged, so that a message about the
// resolved scenario can still name the line that the user wrote.
class Places final : public Origin {
 public:
  std::string describe(const std::string& pointer) const override;
  bool is_set(const std::string& pointer) const override { return nearest(pointer).is_set; }
  bool is_of_a_users_file(const std::string& pointer) const override {
    return !nearest(pointer).is_builtin && !is_set(pointer);
  }

  // The place of `pointer`, else of its nearest ancestor that has one.
  const Place& nearest(const std::string& pointer) const;

  void set(const std::string& pointer, Place place);
  // The highest level of `pointer` and everything below it.
  std::size_t latest_level(const std::string& pointer) const;
  // Removes `pointer` and everything below it.
  void erase(const std::string& pointer);
  // Copies from `other` the places of `pointer` and of everything below it.
  void adopt(const std::string& pointer, const Places& other);
  // The same, but as the places of `as`.
  void graft(const std::string& pointer, const Places& other, const std::string& as);

 private:
  std::map<std::string, Place> places_;
};

// A value for a message: short, on one line, printable.
std::string shown(const nlohmann::json& value);
// Text for a message: without control characters and broken UTF-8, cut after 160 bytes.
std::string shown_text(std::string_view text);

// The text of a file of at most 4 MiB, which is far above any scenario or rig. Throws InputError:
// `prefix`, "cannot be read" and the reason; `thing` is what the text is of.
std::string read_input_file(const std::string& path, const std::string& prefix,
                            std::string_view thing);
[[noreturn]] void fail_to_read(const std::string& prefix, std::string_view reason);

struct PlacedDocument {
  nlohmann::json root;
  Places places;
};

// `file` is the place of all values, but for their lines; its label is the file's name in messages.
// Throws InputError with line and column.
PlacedDocument parse_placed(std::string_view text, const Place& file);

}  // namespace simbench::scenarios
