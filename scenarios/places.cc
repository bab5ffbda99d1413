#include "scenarios/places.h"

#include <algorithm>
#include <utility>

namespace simbench::scenarios {
namespace {

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

}  // namespace simbench::scenarios
