#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include "reports/archive/archive_reader.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using evaluation::Row;
using evaluation::SeedScore;

constexpr std::size_t kCells = 5;  // of a line of either file

// One of the archive's CSV files, line by line. The first cell may be quoted (RFC 4180).
class CsvFile {
 public:
  CsvFile(const Archive& archive, const char* name, std::string_view header)
      : path_((std::filesystem::path(archive.path) / name).string()), in_(path_) {
    if (!in_) fail("cannot be read; only an archive's folder has it");
    if (!next() || line_ != header) fail(fmt::format("line 1 has to be '{}'", header));
  }

  // Splits the next line, which must have kCells cells; false at the end.
  bool next_row() {
    if (!next()) return false;
    std::string_view rest = line_;
    name_ = take_name(rest);
    for (std::size_t i = 1; i < kCells; ++i) {
      const std::size_t comma = rest.find(',');
      if ((comma == std::string_view::npos) != (i == kCells - 1)) {
        fail(fmt::format("{} cells are allowed, not more or fewer; was the file cut short?",
                         kCells));
      }
      cells_[i] = rest.substr(0, comma);
      rest.remove_prefix(i == kCells - 1 ? rest.size() : comma + 1);
    }
    return true;
  }

  const std::string& name() const { return name_; }
  std::string_view text(std::size_t cell) const { return cells_[cell]; }
  template <class Number>
  Number number(std::size_t cell) const {
    const std::string_view text = cells_[cell];
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(fmt::format("found '{}', allowed: a number", scenarios::shown_text(text)));
    }
    return value;
  }
  // An empty cell is NaN.
  double value(std::size_t cell) const {
    return cells_[cell].empty() ? std::numeric_limits<double>::quiet_NaN() : number<double>(cell);
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw scenarios::InputError(fmt::format("{}:{}: {}", path_, number_, problem));
  }

 private:
  bool next() {
    ++number_;
    return static_cast<bool>(std::getline(in_, line_));
  }

  // The first cell, without its quotes; leaves what follows the comma.
  static std::string take_name(std::string_view& rest) {
    std::string name;
    bool quoted = false;
    std::size_t i = 0;
    for (; i < rest.size() && (quoted || rest[i] != ','); ++i) {
      if (rest[i] != '"') {
        name += rest[i];
      } else if (quoted && i + 1 < rest.size() && rest[i + 1] == '"') {
        name += rest[++i];
      } else {
        quoted = !quoted;
      }
    }
    rest.remove_prefix(std::min(i + 1, rest.size()));
    return name;
  }

  std::string path_;
  std::ifstream in_;
  std::string line_;
  std::string name_;
  std::size_t number_ = 0;
  std::string_view cells_[kCells];
};

// The score that a line, which begins with pipeline and seed, is about.
SeedScore& score_of(const CsvFile& file, evaluation::Results& results) {
  const auto seed = file.number<std::uint64_t>(1);
  if (seed < results.first_seed || seed - results.first_seed >= results.seed_count) {
    file.fail(fmt::format("found seed {}, allowed: the {} seeds from {} of results.json", seed,
                          results.seed_count, results.first_seed));
  }
  for (Row& row : results.rows) {
    if (row.pipeline == file.name()) return row.seeds[seed - results.first_seed];
  }
  file.fail(fmt::format("found pipeline '{}', which results.json does not have",
                        scenarios::shown_text(file.name())));
}

}  // namespace

void read_seed_details(Archive& archive) {
  evaluation::Results& results = archive.results;
  for (Row& row : results.rows) {
    row.seeds.assign(results.seed_count, SeedScore{});
    for (std::size_t i = 0; i < row.seeds.size(); ++i) row.seeds[i].seed = results.first_seed + i;
  }
  CsvFile frames(archive, "frames.csv", "pipeline,seed,pulse,spread_ms,deviation_ms");
  while (frames.next_row()) {
    score_of(frames, results)
        .pulses.push_back({.pulse = frames.number<std::int64_t>(2),
                           .spread_ms = frames.value(3),
                           .deviation_ms = frames.value(4)});
  }
  CsvFile hosts(archive, "hosts.csv", "pipeline,seed,host,error_ms,synchronised");
  while (hosts.next_row()) {
    SeedScore& score = score_of(hosts, results);
    if (hosts.number<std::size_t>(2) != score.host_errors_ms.size()) {
      hosts.fail(fmt::format("found host {}, allowed: {}, the next one", hosts.text(2),
                             score.host_errors_ms.size()));
    }
    score.host_errors_ms.push_back(hosts.value(3));
  }
}

}  // namespace simbench::reports
