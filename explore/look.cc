#include "explore/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "app/answer.h"
#include "app/figure_source.h"
#include "app/interrupt.h"
#include "app/results_text.h"
#include "evaluation/answer/answer.h"
#include "explore/measured.h"
#include "explore/picture.h"
#include "recording/collected.h"
#include "recording/recording.h"
#include "reports/page/html_page.h"
#include "reports/text/answer_json.h"

namespace simbench::explore {
namespace {

using evaluation::Results;
using reports::Json;

constexpr std::size_t kMostFigures = 16;
constexpr const char* kOverSeeds = "distributions";

std::string line_of(const Json& event) {
  return event.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

bool flag_in(const Json& json, const char* member) {
  const auto found = json.find(member);
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

// A state that is shown, and what is known of it.
struct Look::View {
  explicit View(scenarios::Scenario of_world)
      : world(std::move(of_world)),
        evaluation(world, [this] { return app::simulated_world(world); },
                   {.share_captures = true, .cancel = &app::InterruptHandler::flag()}) {}

  scenarios::Scenario world;
  evaluation::GrowingEvaluation evaluation;
  const Results* results = nullptr;
  std::string pipeline{};  // shown in detail
  // The last picture; its figures and comparisons are made of it.
  std::optional<reports::Archive> archive{};
};

LookRequest request_of(const Json& json, const PageSubject& subject) {
  if (!json.is_object() || !json.contains("states") || !json.at("states").is_array()) {
    throw StateRefused("", "the page sent no states");
  }
  LookRequest request;
  for (const Json& state : json.at("states")) request.states.push_back(state_of(state, subject));
  if (request.states.empty() || request.states.size() > 2) {
    throw StateRefused("", "the page sent neither one state nor two");
  }
  if (json.contains("seeds") && json.at("seeds").is_number_unsigned()) {
    request.seeds = std::clamp<std::uint64_t>(json.at("seeds"), 1, kMostSeeds);
  }
  if (json.contains("pipeline") && json.at("pipeline").is_string()) {
    request.pipeline = json.at("pipeline");
  }
  if (json.contains("figures") && json.at("figures").is_array()) {
    for (const Json& id : json.at("figures")) {
      if (id.is_string() && request.figures.size() < kMostFigures) request.figures.push_back(id);
    }
  }
  request.budget = flag_in(json, "budget");
  request.levers = flag_in(json, "levers");
  if (json.contains("format")) {
    const Json& format = json.at("format");
    if (format != "json" && format != "csv" && format != "tidy") {
      throw StateRefused("", "the page sent another format than json, csv or tidy");
    }
    request.format = format;
  }
  return request;
}

Look::Look(LookRequest request, const PageSubject& subject,
           std::shared_ptr<server::PageStream> stream)
    : request_(std::move(request)), subject_(subject), stream_(std::move(stream)) {}
Look::~Look() = default;

void Look::send(const Json& event) { stream_->send(line_of(event)); }

bool Look::step() {
  ++steps_;
  try {
    if (make_step()) return true;
  } catch (const RecordingCancelled&) {
    throw;
  } catch (const evaluation::EvaluationCancelled&) {
    throw;
  } catch (const std::exception& failure) {
    send({{"event", "failed"}, {"message", failure.what()}});
  }
  stream_->end();
  return false;
}

bool Look::make_step() {
  switch (stage_) {
    case Stage::kWorlds:
      make_worlds();
      return stage_ != Stage::kEnd;
    case Stage::kPicture:
      make_picture(first_seeds());
      stage_ = request_.levers ? Stage::kLevers : Stage::kRun;
      return true;
    case Stage::kRun:
      if (!request_.figures.empty()) make_figures("run", request_.figures, false);
      stage_ = Stage::kBeside;
      return true;
    case Stage::kBeside:
      if (subject_.measured) make_beside();
      stage_ = Stage::kBudget;
      return true;
    case Stage::kBudget:
      if (request_.budget) make_figures("budget", {"budget"}, true);
      stage_ = Stage::kMore;
      return true;
    case Stage::kMore:
      if (seeds_ < std::min(request_.seeds, affordable_seeds())) {
        make_picture(std::min({2 * seeds_, request_.seeds, affordable_seeds()}));
        return true;
      }
      break;
    case Stage::kLevers:
      make_levers();
      break;
    case Stage::kText:
      make_text();
      return false;
    case Stage::kEnd:
      return false;
  }
  const bool is_cut = seeds_ < request_.seeds && !request_.levers;
  send({{"event", "end"},
        {"seeds", seeds_},
        {"why",
         is_cut ? "more seeds of so many pipelines would not fit into this page's memory" : ""}});
  return false;
}

// How many seeds the first picture has: one where all would be long in coming, which one tells.
std::uint64_t Look::first_seeds() {
  if (request_.at_once) return request_.seeds;
  const std::uint64_t wanted = std::min(kFirstSeeds, request_.seeds);
  const auto begin = std::chrono::steady_clock::now();
  for (const std::unique_ptr<View>& view : views_) view->evaluation.up_to(1);
  const std::chrono::duration<double> one = std::chrono::steady_clock::now() - begin;
  return one.count() * static_cast<double>(wanted) > request_.patience_s ? 1 : wanted;
}

void Look::make_worlds() {
  Json worlds = Json::array();
  for (std::size_t i = 0; i < request_.states.size(); ++i) {
    try {
      views_.push_back(std::make_unique<View>(world_of(request_.states[i], subject_)));
    } catch (const StateRefused& refused) {
      send({{"event", "refused"},
            {"state", i},
            {"pointer", refused.pointer()},
            {"message", refused.what()}});
      stage_ = Stage::kEnd;
      return;
    }
    const scenarios::Scenario& world = views_.back()->world;
    worlds.push_back({{"world", scenarios::world_text(world)},
                      {"warnings", scenarios::warnings(world)},
                      {"changed", scenarios::changed_text(world.derivation)}});
  }
  if (!request_.format.empty()) {
    stage_ = Stage::kText;
    return;
  }
  send({{"event", "worlds"}, {"worlds", std::move(worlds)}});
  stage_ = Stage::kPicture;
}

void Look::make_picture(std::uint64_t seeds) {
  Json shown = Json::array();
  for (const std::unique_ptr<View>& view : views_) {
    view->results = &view->evaluation.up_to(seeds);
    const Results& results = *view->results;
    const reports::ResultsAnswer answer =
        reports::results_answer(results, {}, scenarios::warnings(view->world));
    shown.push_back(picture_json(results, view->world, answer));
    if (view->pipeline.empty()) {
      const evaluation::Row* const best = evaluation::best_of(results);
      const bool is_there = evaluation::find_row(results.rows, request_.pipeline) != nullptr;
      view->pipeline = is_there               ? request_.pipeline
                       : best != nullptr      ? best->pipeline
                       : results.rows.empty() ? ""
                                              : results.rows.front().pipeline;
    }
    view->archive = archive_of(results, view->world, view == views_.front() ? "A" : "B");
  }
  seeds_ = seeds;
  Json comparison;
  if (views_.size() == 2) comparison = comparison_of(*views_[0]->archive, *views_[1]->archive);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin_;
  send({{"event", "picture"},
        {"seeds", seeds},
        {"elapsed_ms", elapsed.count()},
        {"views", std::move(shown)},
        {"comparison", std::move(comparison)}});
  if (!request_.levers) make_rest_of_picture();
}

void Look::make_rest_of_picture() {
  make_figures("seeds", {kOverSeeds}, false);
  if (request_.at_once) return;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    send({{"event", "tables"},
          {"state", i},
          {"tables", tables_html(*views_[i]->results, views_[i]->world)}});
  }
}

void Look::make_figures(const char* of, const std::vector<std::string>& ids, bool budget) {
  for (std::size_t i = 0; i < views_.size(); ++i) {
    View& view = *views_[i];
    if (view.pipeline.empty()) continue;
    app::FigureOptions options{.figures = ids};
    if (ids.front() != kOverSeeds) options.pipelines = {view.pipeline};
    if (budget) options.budget_seeds = 1;
    const app::ArchiveFigures made = app::archive_figures(*view.archive, options);
    Json event = {{"event", "figures"},
                  {"state", i},
                  {"of", of},
                  {"pipeline", view.pipeline},
                  {"notes", made.notes},
                  {"data", Json::parse(reports::figures_json(made.figures))}};
    send(event);
  }
}

void Look::make_beside() {
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (request_.states[i].scenario != subject_.name) continue;
    Json event = {{"event", "beside"}, {"state", i}};
    event.update(beside_json(*subject_.measured, views_[i]->world));
    send(event);
  }
}

void Look::make_levers() {
  const View& view = *views_.front();
  const reports::ResultsAnswer answer = app::run_answer(*view.results, view.world, {}, nullptr);
  Json tried = Json::array();
  if (answer.levers) {
    for (const evaluation::Lever& lever : answer.levers->effective) {
      Json sets = Json::array();
      for (const scenarios::Override& set : lever.sets) {
        sets.push_back({{"pointer", set.pointer}, {"value", set.value}});
      }
      tried.push_back({{"what", lever.what},
                       {"pipeline", lever.pipeline},
                       {"sets", std::move(sets)},
                       {"from", lever.from},
                       {"to", lever.to}});
    }
  }
  send({{"event", "levers"},
        {"answer", reports::answer_json(answer.text)},
        {"levers", std::move(tried)}});
}

void Look::make_text() {
  View& view = *views_.front();
  const Results& results = view.evaluation.up_to(request_.seeds);
  const reports::ResultsAnswer answer =
      app::run_answer(results, view.world, {.levers = request_.levers}, nullptr);
  stream_->send(app::results_text(results, view.world, request_.format, app::Detail::kAll, answer));
}

// Pulses are what a page's memory goes for.
std::uint64_t Look::affordable_seeds() const {
  double bytes = 0;  // of a seed
  for (const std::unique_ptr<View>& view : views_) {
    for (const evaluation::Row& row : view->results->rows) {
      for (const evaluation::SeedScore& seed : row.seeds) {
        bytes += static_cast<double>(sizeof(seed) +
                                     seed.pulses.size() * sizeof(evaluation::PulseScore)) /
                 static_cast<double>(row.seeds.size());
      }
    }
  }
  return bytes > 0 ? static_cast<std::uint64_t>(std::max(kMostLookBytes / bytes, 8.0)) : kMostSeeds;
}

}  // namespace simbench::explore
