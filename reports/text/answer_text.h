// The answer that a report begins with: one sentence, then what else a reader wants to know at
// once.
//
// Terminal, files and pages have the same: the lead, then a line for each of the rest, behind its
// label ("Sets: none of 960 mixes pulses."). Labels are a word or two; without them the texts are
// whole sentences. All of it is computed from results.
//
//   AnswerText answer{.lead = "chrony is best: 0.155 ms."};
//   answer.add("Uncertain", "1 seed says little about other worlds.");
//   document.head = paragraphs(answer);
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

// An answer says of fewer seeds that they say little about other worlds: not even from the least to
// the largest of them do they hold the median with 95 %.
inline constexpr std::size_t kFewestSeeds = 6;
// "3 seeds say little about other worlds"; `whose` (" of a point") follows the seeds.
std::string few_seeds_text(std::size_t seeds, std::string_view whose = "");

struct AnswerPoint {
  std::string label;
  std::string text;  // sentences
};

struct AnswerText {
  std::string lead{};  // a sentence or two; empty: there is no answer
  std::vector<AnswerPoint> points{};

  // Nothing is added for an empty text.
  void add(std::string label, std::string text);
};

// The lead and a line for each point, for the head of a document; none without an answer.
std::vector<std::string> paragraphs(const AnswerText& answer);

// "" without an answer.
std::string html(const AnswerText& answer);

}  // namespace simbench::reports
