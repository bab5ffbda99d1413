// Ready-made sweeps: a question, and the scenario and parameters that answer it
// (scenarios/studies/*.json, whose schema documents every member; built into the program).
//
// A new study is a new file in that folder, without any other change.
//
//   simbench sweep --study scalability -o results/scalability
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/choices.h"

namespace simbench::scenarios {

// What a sweep prints and draws.
enum class StudyTable : std::uint8_t { kResponse, kHostOrder, kSeedsNeeded, kRanking, kPackets };
constexpr auto words_of(StudyTable) {
  using enum StudyTable;
  return std::to_array<Word<StudyTable>>({{kResponse, "response"},
                                          {kHostOrder, "host_order"},
                                          {kSeedsNeeded, "seeds_needed"},
                                          {kRanking, "ranking"},
                                          {kPackets, "packets"}});
}

struct Study {
  std::string name;
  std::string summary;  // the question it answers, and how to read the answer
  std::string scenario;
  std::vector<std::string> set;    // "/json/pointer=value", for all points
  std::vector<std::string> sweep;  // axes, as `simbench sweep --sweep` takes them
  std::vector<std::string> pipelines;
  std::uint64_t seeds = 0;
  std::vector<StudyTable> tables;
  // The study is about the hosts' clocks alone (simbench sweep --clocks).
  bool clocks = false;
  std::optional<std::uint64_t> duration_s{};
  std::optional<std::uint64_t> from_s{};
};

// In alphabetical order.
const std::vector<Study>& studies();

// Null if there is no such study.
const Study* find_study(std::string_view name);

}  // namespace simbench::scenarios
