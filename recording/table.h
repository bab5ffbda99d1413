// Tables of text, as other programs write them: rows of cells, with or without a heading.
//
// How a table is written is found from its first rows: cells are separated by commas, semicolons,
// tabs or blanks; numbers have a decimal point, or, where it separates nothing, a decimal comma;
// cells may stand in quotes ("" is a quote in them); lines that begin with '#', '%' or "//" are
// comments, and the last one before the first row is the heading if it has as many cells, as numpy
// writes it. Else the first row is the heading if none of its cells is a value. Blank lines are
// skipped.
//
//   TableReader rows(LineReader("errors.csv"));
//   while (const std::vector<std::string_view>* cells = rows.next()) use(*cells, rows.place());
//
// Errors: LineError ("FILE:LINE: ..."): unreadable, a quote without its end. Rows are not checked
// for their number of cells: what is missing is for the user to say. Complexity: linear; memory:
// the first rows, then one.
//
// Source: RFC 4180, and the forms of numpy.savetxt, pandas, MATLAB, LibreOffice.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/line_reader.h"

namespace simbench {

struct TableDialect {
  static constexpr char kBlanks = ' ';   // any number of blanks and tabs
  static constexpr char kOneColumn = 0;  // a line is a cell
  char separator = ',';
  bool decimal_comma = false;
};

// Nothing may be known of a value: "", NaN, NA, null, "-".
bool is_missing_cell(std::string_view cell);
// A number or a time, or a missing one.
bool is_value_cell(std::string_view cell, bool decimal_comma = false);

// Cells without the blanks and quotes around them. `unquoted` holds those that had quotes inside.
// False if a quote does not end.
[[nodiscard]] bool split_row(std::string_view line, char separator,
                             std::vector<std::string_view>& cells,
                             std::deque<std::string>& unquoted);

class TableReader {
 public:
  explicit TableReader(LineReader lines);

  const TableDialect& dialect() const { return dialect_; }
  // The names of the columns; empty if there are none.
  const std::vector<std::string>& heading() const { return heading_; }
  // The comments before the first row, without their mark.
  const std::vector<std::string>& comments() const { return comments_; }
  // Before the first next(): the first row, and as many as were looked at (100 at most).
  std::vector<std::string> first_row() const;
  std::vector<std::vector<std::string>> first_rows() const;
  // The cells of the next row, valid until the next call; decimal commas are points. Null at the
  // end.
  const std::vector<std::string_view>* next();
  // "FILE:LINE" of that row.
  std::string place() const;
  // Its line alone.
  std::size_t line() const { return line_; }
  const std::string& path() const { return lines_.path(); }
  // After the last row: whether a line without its end was left out.
  bool torn() const { return lines_.torn(); }
  const LineReader& lines() const { return lines_; }

 private:
  struct Kept {
    std::string text;
    std::size_t line;
  };

  std::vector<std::string> cells_of(const Kept& row) const;
  void look_ahead();
  void find_dialect();
  void find_heading();
  const std::vector<std::string_view>* row_of(std::string_view line);

  LineReader lines_;
  TableDialect dialect_{};
  std::vector<std::string> heading_{};
  std::vector<std::string> comments_{};
  std::deque<Kept> ahead_{};  // the first rows
  std::string current_{};     // of them, the one that was given last
  std::size_t line_ = 1;
  std::vector<std::string_view> cells_{};
  std::deque<std::string> unquoted_{};
};

}  // namespace simbench
