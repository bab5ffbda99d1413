#include "explore/demo.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/sweep/sweep_plan.h"
#include "explore/look.h"
#include "explore/parameters.h"
#include "recording/version.h"
#include "reports/page/explore_page.h"
#include "reports/page/html_page.h"

namespace simbench::explore {
namespace {

using evaluation::SweepAxis;
using reports::Json;
using scenarios::InputError;

constexpr std::size_t kMostAxes = 5;

// Keeps what a look sends.
class KeptEvents final : public server::PageStream {
 public:
  void send(std::string text) override {
    Json event = Json::parse(text);
    if (event.at("event") == "failed" || event.at("event") == "refused") {
      problem_ = event.at("message").get<std::string>();
    }
    event.erase("elapsed_ms");
    if (event.at("event") != "end") events_.push_back(std::move(event));
  }
  void end() override {}
  bool is_closed() const override { return false; }
  std::size_t waiting_bytes() const override { return 0; }
  void when_closed(std::function<void()>) override {}

  Json take() { return std::move(events_); }
  const std::string& problem() const { return problem_; }

 private:
  Json events_ = Json::array();
  std::string problem_;
};

std::vector<SweepAxis> axes_of(const DemoRequest& request) {
  if (request.axes.empty() || request.axes.size() > kMostAxes) {
    throw InputError(fmt::format("--sweep: found {} parameters, allowed for --export: 1 to {}",
                                 request.axes.size(), kMostAxes));
  }
  std::vector<SweepAxis> axes;
  std::size_t worlds = 1;
  for (const std::string& text : request.axes) {
    axes.push_back(evaluation::parse_axis(text));
    if (axes.back().pointers.size() != 1) {
      throw InputError(fmt::format(
          "--sweep {}: found several parameters in lockstep, allowed for --export: one", text));
    }
    worlds *= axes.back().steps();
  }
  if (worlds > kMostDemoWorlds) {
    throw InputError(fmt::format("--sweep: found {} worlds, allowed for --export: at most {}",
                                 worlds, kMostDemoWorlds));
  }
  return axes;
}

struct GridPoint {
  std::string key;  // "0,2,1": the step of each axis
  State state;
};

std::vector<GridPoint> grid_of(const PageSubject& subject, const std::vector<SweepAxis>& axes) {
  std::vector<GridPoint> points = {{"",
                                    {.scenario = subject.name,
                                     .pipelines = subject.pipelines,
                                     .first_seed = subject.first_seed}}};
  for (const SweepAxis& axis : axes) {
    std::vector<GridPoint> longer;
    for (const GridPoint& point : points) {
      for (std::size_t step = 0; step < axis.steps(); ++step) {
        GridPoint next = point;
        next.key += (next.key.empty() ? "" : ",") + std::to_string(step);
        next.state.sets.push_back({axis.pointers[0], axis.values[0][step], axis.pointers[0]});
        longer.push_back(std::move(next));
      }
    }
    points = std::move(longer);
  }
  return points;
}

// Before any work: a grid with a hole would be found out by whoever moves a slider there.
void check_worlds(const std::vector<GridPoint>& points, const PageSubject& subject) {
  for (const GridPoint& point : points) {
    try {
      world_of(point.state, subject);
    } catch (const StateRefused& refused) {
      std::vector<std::string> values;
      for (const scenarios::Override& set : point.state.sets) {
        values.push_back(set.pointer + '=' + set.value);
      }
      throw InputError(fmt::format("--sweep: the world with {} cannot be: {}{}{}",
                                   fmt::join(values, ", "), refused.pointer(),
                                   refused.pointer().empty() ? "" : ": ", refused.what()));
    }
  }
}

Json events_of(const GridPoint& point, const PageSubject& subject, std::uint64_t seeds) {
  const auto kept = std::make_shared<KeptEvents>();
  Look look({.states = {point.state}, .seeds = seeds, .at_once = true}, subject, kept);
  while (look.step()) {
  }
  if (!kept->problem().empty()) throw std::runtime_error(point.key + ": " + kept->problem());
  return kept->take();
}

Json parameters_of(const PageSubject& subject, const std::vector<SweepAxis>& axes) {
  const Json all = parameters_json(world_of({.scenario = subject.name}, subject));
  Json chosen = Json::array();
  for (const SweepAxis& axis : axes) {
    const auto found = std::ranges::find_if(
        all, [&](const Json& each) { return each.at("pointer") == axis.pointers[0]; });
    Json parameter = found == all.end() ? Json{{"pointer", axis.pointers[0]},
                                               {"unit", ""},
                                               {"meaning", "A parameter of the scenario"},
                                               {"source", ""},
                                               {"group", ""},
                                               {"value", nullptr}}
                                        : *found;
    parameter["steps"] = Json::array();
    for (const std::string& value : axis.values[0]) {
      parameter["steps"].push_back(Json::parse(value, nullptr, false));
      if (parameter["steps"].back().is_discarded()) parameter["steps"].back() = value;
    }
    chosen.push_back(std::move(parameter));
  }
  return chosen;
}

std::string deflated(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::string out(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(text.data()), text.size(), 9);
  SIMBENCH_ASSERT(status == Z_OK, "the buffer is as large as zlib wants it");
  out.resize(size);
  return out;
}

}  // namespace

std::vector<std::string> usual_axes() {
  return {"/usb/delivery_jitter_transfers=0.01,0.05,0.25,1,4",
          "/network/latency_exponential_ms=0.01,0.05,0.25,1,4", "/cameras/exposure_ms=2,4,8,16"};
}

std::string demo_html(const PageSubject& subject, const DemoRequest& request,
                      const evaluation::Progress& progress) {
  const std::vector<SweepAxis> axes = axes_of(request);
  const std::vector<GridPoint> points = grid_of(subject, axes);
  check_worlds(points, subject);
  Json worlds = Json::object();
  std::uint64_t done = 0;
  for (const GridPoint& point : points) {
    worlds[point.key] = events_of(point, subject, request.seeds);
    if (progress) progress(++done, points.size());
  }
  const Json stored = {
      {"subject", {{"subject", subject.name}, {"version", std::string(version())}}},
      {"seeds", request.seeds},
      {"parameters", parameters_of(subject, axes)},
      {"worlds", std::move(worlds)}};
  std::string page = reports::explore_html(
      reports::base64(deflated(stored.dump(-1, ' ', false, Json::error_handler_t::replace))));
  if (page.size() > kMostDemoBytes) {
    throw InputError(fmt::format(
        "--export: {} worlds make a page of {:.1f} MB, allowed: {:.1f} MB; state fewer values with "
        "--sweep, or fewer --seeds",
        points.size(), static_cast<double>(page.size()) / 1e6,
        static_cast<double>(kMostDemoBytes) / 1e6));
  }
  return page;
}

}  // namespace simbench::explore
