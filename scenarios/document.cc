#include "scenarios/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "scenarios/input_file.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

// Walks the text for nlohmann's lexer, which copies its iterators, and records how far it got.
class WatchedIterator {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  WatchedIterator() = default;
  WatchedIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  reference operator*() const { return *at_; }
  WatchedIterator& operator++() {
    *furthest_ = ++at_;
    return *this;
  }
  WatchedIterator operator++(int) {
    WatchedIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const WatchedIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_ = nullptr;
  const char** furthest_ = nullptr;
};

// The word of the text that `at` points into.
std::string_view word_around(std::string_view text, std::size_t at) {
  const auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("+-._").find(c) != std::string_view::npos;
  };
  constexpr std::size_t kLongest = 40;
  if (at >= text.size()) return text.substr(text.size());
  std::size_t begin = at;
  while (begin > 0 && at - begin < kLongest && is_part(text[begin - 1])) --begin;
  std::size_t end = at + 1;
  while (end < text.size() && end - at < kLongest && is_part(text[end])) ++end;
  return text.substr(begin, end - begin);
}

// nlohmann's reason in plain words; `word` is the place of the mistake.
std::string plain_words(std::string message, std::string_view word) {
  const auto replace = [&message](std::string_view what, std::string_view with) {
    const std::size_t at = message.find(what);
    if (at != std::string::npos) message.replace(at, what.size(), with);
  };
  if (const std::size_t reason = message.find(" - "); reason != std::string::npos) {
    message.erase(0, reason + 3);
  }
  if (const std::size_t near = message.find("; last read: "); near != std::string::npos) {
    message.replace(near, std::string::npos, fmt::format(" near '{}'", shown_text(word)));
  }
  replace("string literal", "text in double quotes");
  replace("'[', '{', or a literal", "a value");
  replace("invalid literal", "no JSON value");
  if (word.starts_with('/')) message += " (JSON has no comments)";
  if (message.starts_with("unexpected '}'; expected text") ||
      message.starts_with("unexpected ']'; expected a value")) {
    message += " (a comma too many?)";
  }
  return message;
}

// Builds the document from the parser's events.
class Builder : public json::json_sax_t {
 public:
  Builder(std::string_view text, const char** furthest) : text_(text), furthest_(furthest) {}

  JsonDocument take() { return std::move(document_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool number_integer(number_integer_t value) override { return add_number(value); }
  bool number_unsigned(number_unsigned_t value) override {
    if (std::in_range<std::int64_t>(value)) return add_number(static_cast<std::int64_t>(value));
    return add_number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    if (std::trunc(value) == value && std::abs(value) <= kExact) {
      return add_number(static_cast<std::int64_t>(value));
    }
    return add_number(value);
  }
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    advance_to(*furthest_ - 1);
    if (open_.back().container->contains(name)) {
      fail(fmt::format("the key \"{}\" stands twice in this object", shown_text(name)), false);
    }
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    constexpr int kNumberOverflow = 406;
    const std::size_t at = position == 0 ? 0 : std::min(text_.size(), position - 1);
    const std::string_view word = word_around(text_, at);
    advance_to(std::max(word.data(), line_start_));
    if (error.id == kNumberOverflow) {
      fail(fmt::format("the number {} is too large", shown_text(token)), false);
    }
    fail("broken JSON: " + plain_words(error.what(), word), true);
  }

 private:
  struct Open {
    json* container;
    std::size_t pointer_length;  // of this container's own pointer, in pointer_
  };

  [[noreturn]] void fail(const std::string& problem, bool is_syntax) const {
    const auto is_start = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    const auto column = std::count_if(line_start_, at_, is_start);
    throw DocumentError(problem, is_syntax, line_, static_cast<std::size_t>(column) + 1);
  }

  // Counts lines up to `to`, which never moves back by more than within a line.
  void advance_to(const char* to) {
    for (; at_ < to; ++at_) {
      if (*at_ != '\n') continue;
      ++line_;
      line_start_ = at_ + 1;
    }
    at_ = std::max(to, line_start_);
  }

  // The lexer has read one character beyond a number, which may be the end of the line.
  template <class Number>
  bool add_number(Number value) {
    advance_to(std::max(*furthest_ - 1, at_));
    insert(value);
    return true;
  }

  bool add(json value) {
    advance_to(*furthest_);
    insert(std::move(value));
    return true;
  }

  bool open(json container) {
    advance_to(*furthest_ - 1);
    if (open_.size() == kMaximumNesting) {
      fail(fmt::format("nested more than {} levels deep", kMaximumNesting), false);
    }
    const std::size_t parent_length = pointer_.size();
    json& inserted = insert(std::move(container), &pointer_);
    open_.push_back({&inserted, parent_length});
    return true;
  }

  bool close() {
    pointer_.resize(open_.back().pointer_length);
    open_.pop_back();
    return true;
  }

  // Inserts the value at the parser's place and records its line; `pointer` receives its pointer.
  json& insert(json value, std::string* pointer = nullptr) {
    std::string place;
    json* inserted = &document_.root;
    if (open_.empty()) {
      document_.root = std::move(value);
    } else if (json& parent = *open_.back().container; parent.is_array()) {
      place = child_pointer(pointer_, std::to_string(parent.size()));
      inserted = &parent.emplace_back(std::move(value));
    } else {
      place = child_pointer(pointer_, key_);
      inserted = &(parent[key_] = std::move(value));
    }
    document_.lines[place] = line_;
    if (pointer != nullptr) *pointer = std::move(place);
    return *inserted;
  }

  std::string_view text_;
  const char** furthest_;
  const char* at_ = text_.data();
  const char* line_start_ = text_.data();
  std::size_t line_ = 1;
  JsonDocument document_;
  std::vector<Open> open_;
  std::string pointer_;  // of the innermost open container
  std::string key_;
};

// The keys below `pointer` are those in [pointer + "/", pointer + "0"): '0' follows '/'.
std::string begin_below(const std::string& pointer) { return pointer + '/'; }
std::string end_below(const std::string& pointer) { return pointer + static_cast<char>('/' + 1); }

// A key may hold anything; a message is one line.
std::string printable(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

}  // namespace

JsonDocument parse_document(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    throw DocumentError("nothing in it; a JSON object was expected", true, 1, 1);
  }
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    const auto lines =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
    throw DocumentError("not text but binary data", true, static_cast<std::size_t>(lines) + 1, 1);
  }
  const char* furthest = text.data();
  Builder builder(text, &furthest);
  const WatchedIterator begin(text.data(), &furthest);
  const WatchedIterator end(text.data() + text.size(), &furthest);
  json::sax_parse(begin, end, &builder);
  return builder.take();
}

std::string child_pointer(const std::string& parent, std::string_view key) {
  std::string pointer = parent + '/';
  for (const char c : key) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

bool is_utf8(const std::string& text) {
  return json(text).dump(-1, ' ', false, json::error_handler_t::replace) ==
         json(text).dump(-1, ' ', false, json::error_handler_t::ignore);
}

std::string shown_text(std::string_view text) {
  constexpr std::size_t kLongest = 160;
  const bool cut = text.size() > kLongest;
  // As a JSON string: escapes, and U+FFFD for what is no UTF-8.
  std::string quoted = json(std::string(text.substr(0, kLongest)))
                           .dump(-1, ' ', false, json::error_handler_t::replace);
  std::string result = quoted.substr(1, quoted.size() - 2);
  for (std::size_t at = 0; (at = result.find("\\\"", at)) != std::string::npos; ++at) {
    result.erase(at, 1);
  }
  return cut ? result + "..." : result;
}

std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_string()) return '"' + shown_text(value.get_ref<const std::string&>()) + '"';
  return value.dump();
}

const Place& Places::nearest(const std::string& pointer) const {
  static const Place nowhere{};
  for (std::string ancestor = pointer;; ancestor.resize(ancestor.rfind('/'))) {
    if (const auto found = places_.find(ancestor); found != places_.end()) return found->second;
    if (ancestor.rfind('/') == std::string::npos) return nowhere;
  }
}

std::string Places::describe(const std::string& pointer) const {
  const Place& place = nearest(pointer);
  if (pointer.empty() || (place.is_set && place.set_pointer == pointer)) return place.label;
  return place.label + ": " + printable(pointer);
}

void Places::set(const std::string& pointer, Place place) { places_[pointer] = std::move(place); }

std::size_t Places::latest_level(const std::string& pointer) const {
  std::size_t latest = nearest(pointer).level;
  const auto end = places_.lower_bound(end_below(pointer));
  for (auto at = places_.lower_bound(begin_below(pointer)); at != end; ++at) {
    latest = std::max(latest, at->second.level);
  }
  return latest;
}

void Places::erase(const std::string& pointer) {
  places_.erase(pointer);
  places_.erase(places_.lower_bound(begin_below(pointer)), places_.lower_bound(end_below(pointer)));
}

void Places::adopt(const std::string& pointer, const Places& other) {
  if (const auto found = other.places_.find(pointer); found != other.places_.end()) {
    places_[pointer] = found->second;
  }
  places_.insert(other.places_.lower_bound(begin_below(pointer)),
                 other.places_.lower_bound(end_below(pointer)));
}

void Places::graft(const std::string& pointer, const Places& other, const std::string& as) {
  set(as, other.nearest(pointer));
  const auto end = other.places_.lower_bound(end_below(pointer));
  for (auto at = other.places_.lower_bound(begin_below(pointer)); at != end; ++at) {
    set(as + at->first.substr(pointer.size()), at->second);
  }
}

void fail_to_read(const std::string& prefix, std::string_view reason) {
  throw InputError(fmt::format("{}: cannot be read: {}", prefix, reason));
}

std::string read_input_file(const std::string& path, const std::string& prefix,
                            std::string_view thing) {
  constexpr std::size_t kMaximumBytes = std::size_t{4} << 20;
  try {
    return file_content(path, kMaximumBytes);
  } catch (const FileTooLarge& error) {
    fail_to_read(prefix, fmt::format("{}, which no {} needs", error.what(), thing));
  } catch (const FileError& error) {
    fail_to_read(prefix, error.what());
  }
}

PlacedDocument parse_placed(std::string_view text, const Place& file) {
  PlacedDocument placed;
  try {
    JsonDocument parsed = parse_document(text);
    placed.root = std::move(parsed.root);
    for (const auto& [pointer, line] : parsed.lines) {
      Place place = file;
      place.label = fmt::format("{}:{}", file.label, line);
      place.line = line;
      placed.places.set(pointer, std::move(place));
    }
  } catch (const DocumentError& error) {
    throw InputError(
        fmt::format("{}:{}:{}: {}", file.label, error.line(), error.column(), error.what()));
  }
  return placed;
}

}  // namespace simbench::scenarios
