#include "scenarios/part.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/document.h"
#include "scenarios/schema.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

const JsonSchema& part_schema() {
  static const JsonSchema schema(json::parse(part_schema_text()));
  return schema;
}

// The schema has checked the word.
template <class Enum>
Enum word_in(const json& in) {
  const auto text = in.get<std::string>();
  const auto words = words_of(Enum{});
  return std::ranges::find_if(words, [&](const auto& word) { return word.text == text; })->value;
}

std::vector<std::string> texts_in(const json& in, const char* member) {
  return in.value(member, std::vector<std::string>());
}

Part part_of(const json& in) {
  Part part{.part = in.at("part"),
            .kind = word_in<PartKind>(in.at("kind")),
            .name = in.at("name"),
            .prices = {},
            .price_source = in.at("price_source"),
            .source = in.at("source"),
            .sets = {},
            .host_sync = texts_in(in, "host_sync"),
            .with = texts_in(in, "with"),
            .hosts = in.value("hosts", std::int64_t{0}),
            .cameras = in.value("cameras", std::int64_t{0}),
            .slots = in.value("slots", std::int64_t{0}),
            .world = in.value("world", std::string()),
            .is_host = in.value("is_host", false),
            .computers = in.value("computers", std::int64_t{0}),
            .capture_alignment = texts_in(in, "capture_alignment"),
            .device_time = texts_in(in, "device_time")};
  for (const json& price : in.at("prices")) {
    part.prices.push_back({.per = word_in<Per>(price.at("per")),
                           .range = {price.at("low_eur"), price.at("high_eur")}});
  }
  const json sets = in.value("sets", json::object());
  for (const auto& [pointer, value] : sets.items()) {
    part.sets.push_back({pointer, value.dump(), fmt::format("part {}: {}", part.part, pointer)});
  }
  return part;
}

// What the schema cannot say.
void check_part(const Part& part, const Places& places) {
  for (std::size_t i = 0; i < part.prices.size(); ++i) {
    const PriceRange& range = part.prices[i].range;
    if (range.low_eur <= range.high_eur) continue;
    const std::string pointer = fmt::format("/prices/{}/high_eur", i);
    throw InputError(fmt::format("{}: found {}, allowed at least low_eur, {}",
                                 places.describe(pointer), range.high_eur, range.low_eur));
  }
  const auto needs = [&](PartKind kind, bool is_there, const char* member) {
    if (part.kind != kind || is_there) return;
    throw InputError(fmt::format("{}: found no {}, which every {} has", places.describe("/kind"),
                                 member, to_text(kind)));
  };
  needs(PartKind::kCamera, !part.world.empty(), "world");
  needs(PartKind::kCamera, !part.device_time.empty(), "device_time");
  needs(PartKind::kHost, part.cameras > 0, "cameras");
  needs(PartKind::kUsbCard, part.cameras > 0, "cameras");
  needs(PartKind::kSwitch, part.hosts > 0, "hosts");
  needs(PartKind::kClock, !part.host_sync.empty(), "host_sync");
}

}  // namespace

PriceRange price_of(const Part& part, PartCount count) {
  PriceRange sum;
  for (const PartPrice& price : part.prices) {
    const auto times = static_cast<double>(price.per == Per::kRig    ? 1
                                           : price.per == Per::kHost ? count.hosts
                                                                     : count.pieces);
    sum += {times * price.range.low_eur, times * price.range.high_eur};
  }
  return sum;
}

Part load_part_text(const std::string& text, const std::string& file_name) {
  const PlacedDocument document = parse_placed(text, {.label = file_name});
  validate(document.root, part_schema(), document.places);
  Part part = part_of(document.root);
  check_part(part, document.places);
  return part;
}

Part load_part(const std::string& path) {
  return load_part_text(read_input_file(path, path, "part"), path);
}

const std::vector<Part>& parts() {
  static const std::vector<Part> all = [] {
    std::vector<Part> loaded;
    for (const BuiltinFile& file : part_files()) {
      loaded.push_back(part_of(json::parse(file.text)));
    }
    return loaded;
  }();
  return all;
}

const Part* find_part(std::string_view name) {
  const std::vector<Part>& all = parts();
  const auto found = std::ranges::find(all, name, &Part::part);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace simbench::scenarios
