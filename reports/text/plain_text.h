// The page that plain text is laid out for, and prose on it. Tables: plain() of
// reports/text/block.h.
//
// The page is as wide as need be until set_page_width() says otherwise: the command does so once at
// its start, for the terminal it prints to.
//
// A table that fits stands in one part. Else its columns are dealt out in order to as few parts as
// they need, an empty line between two, each with the key columns first. A column of prose (a cell
// of more than kProseWidth with a blank in it) may be narrowed to that, its cells going on below;
// as much as a part must, its widest first. A single word is never broken, and a column that does
// not fit beside the keys has a part of its own, where its longest words stand out.
#ifndef SIMBENCH_REPORTS_TEXT_PLAIN_TEXT_H_
#define SIMBENCH_REPORTS_TEXT_PLAIN_TEXT_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

// The page's width in columns; std::nullopt: as wide as need be. Not for use while another thread
// prints.
void set_page_width(std::optional<std::size_t> columns);
std::optional<std::size_t> page_width();

// A page as wide as need be while it lives, whatever the terminal: for text that goes to a file.
class FilePage {
 public:
  FilePage() : width_(page_width()) { set_page_width(std::nullopt); }
  ~FilePage() { set_page_width(width_); }
  FilePage(const FilePage&) = delete;
  FilePage& operator=(const FilePage&) = delete;

 private:
  std::optional<std::size_t> width_;
};

inline constexpr std::size_t kTextWidth = 140;
inline constexpr std::size_t kProseWidth = 24;

// Prose in lines of at most kTextWidth columns, on a narrower page of its width (a longer word has
// a line of its own), each after `indent` blanks and ended by '\n'.
std::string wrapped(std::string_view text, std::size_t indent = 0);

// The text with every line that is wider than the page broken at a blank; what follows stands two
// blanks deeper than its line. Unchanged where the page is as wide as need be.
std::string fitted(std::string_view text);

// The words of `text` in lines of at most `width`, one blank between words; a longer word has a
// line of its own. No line for no words.
std::vector<std::string> words_in_lines(std::string_view text, std::size_t width);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_PLAIN_TEXT_H_
