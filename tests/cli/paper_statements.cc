#include "tests/cli/paper_statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace simbench {
namespace {

std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at = text.find(separator); at != std::string::npos;
       at = text.find(separator, from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + separator.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

// The cells of a line of a table; none of any other line, a heading or a rule.
std::vector<std::string> cells_of(const std::string& line) {
  if (!line.starts_with("| ") || !line.ends_with(" |") || line.starts_with("| -")) return {};
  return split(line.substr(2, line.size() - 4), " | ");
}

bool is_number(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return std::isdigit(c) != 0; });
}

// A paragraph, and the numbers of some of its sentences.
struct Sentences {
  std::string section;
  std::size_t paragraph = 0;  // from 1
  std::vector<int> numbers;
};

// What "3.2/1: 4-7, 9" names; nothing of any other text.
std::optional<Sentences> sentences_in(const std::string& place) {
  const std::size_t slash = place.find('/');
  const std::size_t colon = place.find(": ");
  if (slash == std::string::npos || colon == std::string::npos || colon < slash) return {};
  Sentences found;
  found.section = place.substr(0, slash);
  const std::string paragraph = place.substr(slash + 1, colon - slash - 1);
  if (!is_number(paragraph)) return {};
  found.paragraph = std::stoul(paragraph);
  for (const std::string& part : split(place.substr(colon + 2), ", ")) {
    const std::vector<std::string> ends = split(part, "-");
    if (ends.size() > 2 || !is_number(ends.front()) || !is_number(ends.back())) return {};
    for (int n = std::stoi(ends.front()); n <= std::stoi(ends.back()); ++n) {
      found.numbers.push_back(n);
    }
  }
  return found;
}

// The paper's own numbered parts, of which its figures may be named with a letter.
std::vector<std::string> numbered_parts() {
  std::vector<std::string> parts;
  for (int n = 1; n <= 4; ++n) parts.push_back(fmt::format("eq. ({})", n));
  for (int n = 1; n <= 3; ++n) parts.push_back(fmt::format("Algorithm {}", n));
  for (int n = 1; n <= 4; ++n) parts.push_back(fmt::format("Table {}", n));
  for (int n = 1; n <= 13; ++n) parts.push_back(fmt::format("Fig. {}", n));
  return parts;
}

// "Fig. 2 a" is a part of "Fig. 2", "Fig. 20" is not.
bool is_of(const std::string& place, const std::string& part) {
  return place == part || (place.starts_with(part + " ") && place.size() == part.size() + 2);
}

// Collects what the lines name, and complains of what does not exist.
class Coverage {
 public:
  explicit Coverage(const StatementPage& page) : page_(page) {}

  void add(int line, const std::string& place) {
    if (const auto sentences = sentences_in(place)) {
      for (const int n : sentences->numbers) add(line, *sentences, n);
      return;
    }
    const auto part = std::ranges::find_if(
        parts_, [&place](const std::string& known) { return is_of(place, known); });
    if (part == parts_.end()) {
      problems_.push_back(fmt::format("line {}: the paper has no '{}'", line, place));
    } else {
      named_parts_.insert(*part);
    }
  }

  std::vector<std::string> problems() {
    for (const std::string& part : parts_) {
      if (!named_parts_.contains(part)) problems_.push_back(part + " is in no line");
    }
    for (const auto& [section, counts] : page_.sentences_of) {
      for (std::size_t paragraph = 1; paragraph <= counts.size(); ++paragraph) {
        for (int n = 1; n <= counts[paragraph - 1]; ++n) {
          const std::string name = fmt::format("{}/{}: {}", section, paragraph, n);
          if (!named_sentences_.contains(name)) problems_.push_back(name + " is in no line");
        }
      }
    }
    return problems_;
  }

 private:
  void add(int line, const Sentences& sentences, int n) {
    const std::string name = fmt::format("{}/{}: {}", sentences.section, sentences.paragraph, n);
    named_sentences_.insert(name);
    const auto section = page_.sentences_of.find(sentences.section);
    const bool exists = section != page_.sentences_of.end() && sentences.paragraph >= 1 &&
                        sentences.paragraph <= section->second.size() && n >= 1 &&
                        n <= section->second[sentences.paragraph - 1];
    if (!exists) problems_.push_back(fmt::format("line {}: the paper has no '{}'", line, name));
  }

  const StatementPage& page_;
  std::vector<std::string> parts_ = numbered_parts();
  std::set<std::string> named_parts_;
  std::set<std::string> named_sentences_;
  std::vector<std::string> problems_;
};

}  // namespace

std::string statements_text() {
  std::ifstream page(SIMBENCH_SOURCE_DIR "/docs/reference/paper_statements.md");
  std::ostringstream text;
  text << page.rdbuf();
  return text.str();
}

StatementPage read_statements(const std::string& text) {
  StatementPage page;
  std::istringstream lines(text);
  std::string heading;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("## ")) heading = line;
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() == 5 && is_number(cells[0])) {
      page.rows.push_back({number, cells[0], split(cells[1], "; "), cells[3], cells[4]});
    }
    if (cells.size() != 2 || cells[0].empty() || std::isdigit(cells[0][0]) == 0) continue;
    if (heading.ends_with("Sentences without a line")) {
      for (const std::string& place : split(cells[0], "; ")) {
        page.unlisted.emplace_back(number, place);
      }
    } else if (heading.ends_with("Sentences of each paragraph")) {
      for (const std::string& count : split(cells[1], ", ")) {
        page.sentences_of[cells[0]].push_back(is_number(count) ? std::stoi(count) : 0);
      }
    }
  }
  return page;
}

std::vector<std::string> quoted_names(const std::string& cell) {
  const std::vector<std::string> parts = split(cell, "`");
  std::vector<std::string> names;
  for (std::size_t i = 1; i < parts.size(); i += 2) names.push_back(parts[i]);
  return names;
}

std::vector<std::string> problems_of_coverage(const StatementPage& page) {
  Coverage coverage(page);
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < page.rows.size(); ++i) {
    const StatementRow& row = page.rows[i];
    if (row.number != std::to_string(i + 1)) {
      problems.push_back(
          fmt::format("line {}: number {} should be {}", row.line, row.number, i + 1));
    }
    for (const std::string& place : row.places) coverage.add(row.line, place);
  }
  for (const auto& [line, place] : page.unlisted) coverage.add(line, place);
  for (const std::string& problem : coverage.problems()) problems.push_back(problem);
  return problems;
}

}  // namespace simbench
