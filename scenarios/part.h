// Parts of a rig that a buyer can choose: cameras, hosts, USB cards, switches and clock sources,
// one file per part (scenarios/parts/*.json, whose schema documents every member). `simbench
// advise` combines them; `simbench list parts` prints them.
//
// A part states its price class, what it changes in a scenario (as --set would) and what it makes
// possible. Prices are rough ranges of what is sold, with their source or as assumptions.
//
// A new part is a new file in that folder, without any other change; one of the user's own is a
// file of the same form (load_part).
//
//   const Part* cards = find_part("ptp_cards");
//   cards->host_sync;                                   // {"ptp_e2e_hardware"}
//   price_of(*cards, {.hosts = 8, .pieces = 8}).low_eur;  // 240
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/choices.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {

enum class PartKind : std::uint8_t { kCamera, kHost, kUsbCard, kSwitch, kClock };
constexpr auto words_of(PartKind) {
  using enum PartKind;
  return std::to_array<Word<PartKind>>({{kCamera, "camera"},
                                        {kHost, "host"},
                                        {kUsbCard, "usb_card"},
                                        {kSwitch, "switch"},
                                        {kClock, "clock"}});
}

// How often a price is paid.
enum class Per : std::uint8_t { kRig, kHost, kPiece };
constexpr auto words_of(Per) {
  using enum Per;
  return std::to_array<Word<Per>>({{kRig, "rig"}, {kHost, "host"}, {kPiece, "piece"}});
}

// From what is sold cheaply to what is sold dearly.
struct PriceRange {
  double low_eur = 0;
  double high_eur = 0;

  double middle_eur() const { return (low_eur + high_eur) / 2; }
  PriceRange& operator+=(const PriceRange& other) {
    low_eur += other.low_eur;
    high_eur += other.high_eur;
    return *this;
  }
};

struct PartPrice {
  Per per{};
  PriceRange range;
};

struct Part {
  std::string part;  // its name
  PartKind kind{};
  std::string name;  // what it is
  std::vector<PartPrice> prices;
  std::string price_source;
  std::string source;
  std::vector<Override> sets;          // labelled with the part
  std::vector<std::string> host_sync;  // clocks, cameras that are hosts
  std::vector<std::string> with;       // switches: parts for which it matters; empty: all
  std::int64_t hosts = 0;              // switches
  std::int64_t cameras = 0;            // hosts, USB cards
  std::int64_t slots = 0;              // hosts
  std::string world;                   // these and the rest: cameras; a built-in scenario
  bool is_host = false;
  std::int64_t computers = 0;
  std::vector<std::string> capture_alignment;  // empty: a trigger
  std::vector<std::string> device_time;
};

// How many of a part a rig has.
struct PartCount {
  std::int64_t hosts = 0;
  std::int64_t pieces = 0;
};
PriceRange price_of(const Part& part, PartCount count);

// In alphabetical order.
const std::vector<Part>& parts();

// Null if there is no such part.
const Part* find_part(std::string_view name);

// A part of the user's own. Throws InputError.
Part load_part(const std::string& path);
// Loads text as if it were the content of `file_name`.
Part load_part_text(const std::string& text, const std::string& file_name);

}  // namespace simbench::scenarios
