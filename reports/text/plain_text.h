// The page of plain text, and prose on it. Tables: plain() of reports/text/block.h.
//
// Colour only repeats what a word says: green what is good ("better", "best", "inside", "yes"), red
// what is not ("worse", "outside", "no", "FAILED"), cyan a limit or a reference.
//
// The page has no limit until set_page_width(), which the command calls once at its start, for its
// terminal.
//
// A table that fits stands in one part. Otherwise its columns are distributed in order over as few
// parts as possible, each with the key columns first and an empty line between two. A column of
// prose (a cell of more than kProseWidth with a blank in it) may be narrowed to that width, and its
// cells wrap; a part narrows its widest columns first, as much as necessary. A single word is never
// broken. A column that does not fit beside the keys has a part of its own, where its longest words
// exceed it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

struct Table;

// The page's width in columns; std::nullopt: no limit. Not while another thread prints.
void set_page_width(std::optional<std::size_t> columns);
std::optional<std::size_t> page_width();

// Whether cells of verdicts are coloured by ECMA-48's escapes; not until this. Not while another
// thread prints.
void set_page_colour(bool wanted);
bool page_colour();

// A page without limit or colour during its lifetime, for text in a file.
class FilePage {
 public:
  FilePage() : width_(page_width()), colour_(page_colour()) {
    set_page_width(std::nullopt);
    set_page_colour(false);
  }
  ~FilePage() {
    set_page_width(width_);
    set_page_colour(colour_);
  }
  FilePage(const FilePage&) = delete;
  FilePage& operator=(const FilePage&) = delete;

 private:
  std::optional<std::size_t> width_;
  bool colour_;
};

inline constexpr std::size_t kTextWidth = 140;
inline constexpr std::size_t kProseWidth = 24;

// Prose in lines of at most kTextWidth columns or the page's width (a longer word has a line of its
// own), each after `indent` blanks and ended by '\n'.
std::string wrapped(std::string_view text, std::size_t indent = 0);

// A table on the page, as plain() draws it, of printable cells.
std::string aligned(const Table& table);

// Breaks every line that is wider than the page at a blank; the rest is indented by two more
// blanks. Unchanged without a limit.
std::string fitted(std::string_view text);

// The text of a whole page as a terminal may get it: what it would obey stands as \xHH (line ends
// stay), but for the page's own colours, if it has any.
std::string printable_page(std::string_view text);

// The words of `text` in lines of at most `width`, one blank between words; a longer word has a
// line of its own.
std::vector<std::string> words_in_lines(std::string_view text, std::size_t width);

}  // namespace simbench::reports
