// What a page looks at: one or two states, of which more and more is computed while it stays open.
//
// A look goes on in steps of at most a moment, so that several pages take turns. Each step sends
// events, a line of JSON each:
//
//   {"event": "refused", "state": 0, "pointer": "/usb/...", "message": "found -1, allowed ..."}
//   {"event": "worlds", "worlds": [{"world", "warnings", "changed"}]}
//   {"event": "picture", "seeds": 8, "elapsed_ms", "views": [picture_json()], "comparison": null or
//     comparison_of()}
//   {"event": "figures", "state": 0, "of": "seeds", "run" or "budget", "pipeline", "notes", "data":
//     figures_json()}
//   {"event": "tables", "state": 0, "tables": HTML}, all of them
//   {"event": "beside", "state": 0, ...: beside_json()}, of a rig that was measured
//   {"event": "levers", "answer", "levers": [{"what", "pipeline", "sets", "from", "to"}]}
//   {"event": "end", "seeds": 128, "why": ""}
//   {"event": "failed", "message"}
//
// A look with a format has one event in place of these: the text that `simbench run --format`
// prints of the first state and all its seeds.
//
// The first picture is of kFirstSeeds seeds, or of one where these would take long; then come the
// figures of one run, the budget, and pictures of twice as many seeds each. It ends by itself at
// the wanted number of seeds, or where more would take more than kMostLookBytes; the last event
// says so.
//
// Contract: the results of n seeds are those of `simbench run` with n seeds. A step that is
// cancelled (app/interrupt.h) throws and leaves nothing to send.
//
//   Look look(request_of(json, subject), subject, stream);
//   while (look.step()) {}
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "explore/state.h"
#include "server/request.h"

namespace simbench::explore {

inline constexpr double kMostLookBytes = 24e6;  // of the pulses of all seeds

struct LookRequest {
  std::vector<State> states;           // one or two
  std::uint64_t seeds = 128;           // to end at
  std::string pipeline{};              // shown in detail; "": the best
  std::vector<std::string> figures{};  // of one run, by id
  bool budget = false;
  bool levers = false;    // what would help; then there are neither figures nor further seeds
  std::string format{};   // "json", "csv" or "tidy": the results as a text, with or without levers
  double patience_s = 2;  // for a first picture of all its seeds; longer: it is of one
  bool at_once = false;   // the first picture is of all seeds, and there are no tables
};

// {"states": [...], "seeds", "pipeline", "figures": [ids], "budget", "levers", "format"}; all but
// the states may be left out. Throws StateRefused.
LookRequest request_of(const reports::Json& json, const PageSubject& subject);

class Look {
 public:
  Look(LookRequest request, const PageSubject& subject, std::shared_ptr<server::PageStream> stream);
  ~Look();
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;

  // Whether more remains. Never throws but for a cancelled step.
  bool step();
  std::uint64_t steps() const { return steps_; }
  server::PageStream& stream() { return *stream_; }

 private:
  struct View;
  enum class Stage { kWorlds, kPicture, kRun, kBeside, kBudget, kMore, kLevers, kText, kEnd };

  bool make_step();
  void make_worlds();
  std::uint64_t first_seeds();
  void make_picture(std::uint64_t seeds);
  void make_rest_of_picture();
  void make_figures(const char* of, const std::vector<std::string>& ids, bool budget);
  void make_beside();
  void make_levers();
  void make_text();
  std::uint64_t affordable_seeds() const;
  void send(const reports::Json& event);

  LookRequest request_;
  const PageSubject& subject_;
  std::shared_ptr<server::PageStream> stream_;
  std::vector<std::unique_ptr<View>> views_;
  Stage stage_ = Stage::kWorlds;
  std::uint64_t seeds_ = 0;
  std::uint64_t steps_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace simbench::explore
