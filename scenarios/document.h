// JSON text with the position of every value, so that messages can name the line.
//
// Stricter than JSON where leniency would hide a mistake: a key may stand only once in an object,
// and nesting is limited to kMaximumNesting, which also bounds the recursion of everything that
// walks a document later. A byte order mark is skipped. Whole numbers are held as std::int64_t
// however they are written (480, 480.0, 4.8e2), all others as double.
#ifndef SIMBENCH_SCENARIOS_DOCUMENT_H_
#define SIMBENCH_SCENARIOS_DOCUMENT_H_

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace simbench::scenarios {

inline constexpr std::size_t kMaximumNesting = 64;

struct Document {
  nlohmann::json root;
  std::map<std::string, std::size_t> lines;  // by JSON pointer: of the key, of the array element
};

// Text that is no acceptable JSON; what() says why in plain words.
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
Document parse_document(std::string_view text);

// "/parent" and "a/b" -> "/parent/a~1b" (RFC 6901).
std::string child_pointer(const std::string& parent, std::string_view key);

// Whether the text is UTF-8, as all text in JSON must be.
bool is_utf8(const std::string& text);

// A value for a message: short, on one line, printable.
std::string shown(const nlohmann::json& value);
// Text for a message: no control characters, no broken UTF-8, shortened after some 60 characters.
std::string shown_text(std::string_view text);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_DOCUMENT_H_
