#include "reports/reconstruction/reconstruction_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/results_document.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using reconstruction::CurvePoint;
using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;
using reconstruction::SeedReprojection;
using scenarios::PublishedReprojection;
using scenarios::Studio;
using scenarios::StudioSubject;

struct Point {
  double x = 0;
  double y = 0;
};
using Curve = std::vector<Point>;

// The points that have a value, by x.
Curve curve_of(const std::vector<CurvePoint>& points, double CurvePoint::*x) {
  Curve curve;
  for (const CurvePoint& point : points) {
    const double y = evaluation::median(point.mean_cm);
    if (!std::isnan(y)) curve.push_back({point.*x, y});
  }
  std::stable_sort(curve.begin(), curve.end(),
                   [](const Point& a, const Point& b) { return a.x < b.x; });
  return curve;
}

// The first point above `y`, not before `from`.
std::size_t first_above(const Curve& curve, double y, std::size_t from) {
  while (from < curve.size() && !(curve[from].y > y)) ++from;
  return from;
}

double slope_before(const Curve& curve, std::size_t end) {
  const Point& a = curve[end - 1];
  const Point& b = curve[end];
  return (b.y - a.y) / (b.x - a.x);
}

SyncLimit limit_of(const std::vector<CurvePoint>& points) {
  SyncLimit limit{.speed_m_per_s = points.front().speed_m_per_s,
                  .speed_factor = points.front().speed_factor,
                  .limit_ms = std::nullopt};
  const Curve curve = curve_of(points, &CurvePoint::desync_ms);
  if (curve.empty()) return limit;
  limit.floor_cm = curve.front().y;
  limit.last_ms = curve.back().x;
  if (curve.size() < 2) return limit;
  const double tolerated = limit.floor_cm * (1 + kToleratedGrowth);
  const std::size_t above = first_above(curve, tolerated, 1);
  const std::size_t end = std::min(above, curve.size() - 1);
  limit.cost_cm_per_ms = slope_before(curve, end);
  if (above < curve.size()) {
    limit.limit_ms = curve[end - 1].x + (tolerated - curve[end - 1].y) / limit.cost_cm_per_ms;
  }
  return limit;
}

double mean_at(const ReprojectionRow& row, std::uint64_t seed) {
  for (const reconstruction::SeedReprojection& each : row.seeds) {
    if (each.seed == seed) return each.errors.mean_cm;
  }
  return reconstruction::kNoError;
}

constexpr const char* kErrorLegend =
    "error: distance between a vertex of the reconstructed mesh and the point that a depth camera "
    "measured where it sees that vertex. A value is the median over the seeds, [a, b] their band "
    "from 5 to 95 %.";
constexpr const char* kDesyncLegend =
    "desynchronisation: how far apart the true mid-exposures of a frame set are. In every row "
    "frames are grouped by the nearest global stamp, without a threshold; seeds without a gathered "
    "set: those in which the pipeline's own gathering emitted none.";
constexpr const char* kLimitLegend =
    "desynchronisation up to: the largest one at which the median error stays within 10 % of its "
    "floor, the error at the smallest desynchronisation of the curve (interpolated). cost: the "
    "local slope of the curve there, or at its end.";

std::string motion_text(const StudioSubject& subject) {
  std::string text = fmt::format("motion \"{}\"", to_text(subject.motion));
  if (walks(subject.motion)) text += fmt::format(" at {:g} m/s", subject.walk_speed_m_per_s);
  if (turns(subject.motion)) {
    text += fmt::format("{} {:g} rad/s", walks(subject.motion) ? " and" : " at",
                        subject.turn_rate_rad_per_s);
  }
  if (subject.motion == scenarios::MotionScript::kRaiseArms) {
    text += fmt::format(" at {:g} rad/s", subject.arm_rate_rad_per_s);
  }
  return text;
}

std::string subject_note(const StudioSubject& subject) {
  const std::string who =
      subject.kind == scenarios::SubjectKind::kMesh
          ? fmt::format("The subject is the mesh {}", subject.mesh_file)
          : fmt::format("The subject is a simulated person of {:g} m", subject.height_m);
  return fmt::format("{}, {}; the paper states \"moving person\" and no more.", who,
                     motion_text(subject));
}

std::string assumptions_note(const Studio& studio) {
  return fmt::format(
      "Assumptions: calibration errors of {:g} mm and {:g} degrees per axis, depth noise of {:g} "
      "px of disparity; a vertex counts as seen up to {:g} mm behind the mesh's own z-buffer, "
      "spread by {} pixels.",
      studio.calibration_translation_sigma_mm, studio.calibration_rotation_sigma_deg,
      studio.subpixel_error_px, studio.visibility_tolerance_mm, studio.visibility_spread_px);
}

// A note if the row with the smallest published mean does not depend on time.
std::string floor_note(const std::vector<ReprojectionRow>& rows, const StudioSubject& subject) {
  const ReprojectionRow* best = nullptr;
  for (const ReprojectionRow& row : rows) {
    if (!row.published) continue;
    if (best == nullptr || row.published->mean_cm < best->published->mean_cm) best = &row;
  }
  if (best == nullptr || !walks(subject.motion)) return "";
  const double ms = best->desync_ms().median;
  const double moved_cm = ms * subject.walk_speed_m_per_s / 10;
  if (!(moved_cm < best->mean_cm().median)) return "";
  return fmt::format(
      "In the {} ms of {} the subject moves {} cm: that row measures calibration and depth noise, "
      "and cannot be distinguished from a perfect synchronisation.",
      desync_text(ms), best->pipeline, cm_text(moved_cm));
}

std::string speed_phrase(const CurvePoint& point) {
  if (point.speed_m_per_s > 0) return speed_text(point.speed_m_per_s, point.speed_factor);
  return fmt::format("{:g} times the stated one", point.speed_factor);
}

// Medians and bands of the points, which show the accuracy of the interpolated speed.
std::string points_text(const std::vector<CurvePoint>& points) {
  std::string text;
  for (const CurvePoint& point : points) {
    text += fmt::format("{}{}: {} cm", text.empty() ? "" : ", ", speed_phrase(point),
                        cm_text(evaluation::make_series(point.mean_cm)));
  }
  return text;
}

std::string title_line(const ReconstructionResults& results) {
  return fmt::format(
      "{}: {}, {} each", scenarios::named(results.scenario.name, results.scenario.derivation),
      counted_seeds(results.first_seed, results.seeds), counted(results.frames, "frame set"));
}

// "9.70, outside" (placement_text()); "-" without a published value.
std::string published_text(const std::optional<PublishedReprojection>& published,
                           double PublishedReprojection::*member,
                           const evaluation::Series& simulated) {
  if (!published) return "-";
  const double value = (*published).*member;
  if (std::isnan(simulated.median)) return cm_text(value);
  return fmt::format("{}, {}", cm_text(value),
                     placement_text(evaluation::percentile_of(value, simulated.values)));
}

Table table_4(const ReconstructionResults& results) {
  const std::vector<Field<ReprojectionRow>> fields = {
      pipeline_field<ReprojectionRow>(),
      {{"mean error\ncm"}, [](const auto& row) { return cm_text(row.mean_cm()); }},
      {{"published\nmean cm"},
       [](const auto& row) {
         return published_text(row.published, &PublishedReprojection::mean_cm, row.mean_cm());
       }},
      {{"standard deviation\ncm"}, [](const auto& row) { return cm_text(row.std_cm()); }},
      {{"published\nstd. dev. cm"}, [](const auto& row) {
         return published_text(row.published, &PublishedReprojection::std_cm, row.std_cm());
       }}};
  return table_of(fields, results.rows);
}

Table reconstructed_sets_table(const ReconstructionResults& results) {
  const auto total = [](const char* header, std::int64_t SeedReprojection::*member) {
    return Field<ReprojectionRow>{{header}, [member](const ReprojectionRow& row) {
                                    return count_text(total_over_seeds(row, member));
                                  }};
  };
  const std::vector<Field<ReprojectionRow>> fields = {
      pipeline_field<ReprojectionRow>(),
      {{"median\ncm"}, [](const auto& row) { return cm_text(row.median_cm().median); }},
      {{"95 %\ncm"}, [](const auto& row) { return cm_text(row.p95_cm().median); }},
      {{"desynchronisation\nms"}, [](const auto& row) { return desync_text(row.desync_ms()); }},
      {{"seeds without\na gathered set"},
       [](const auto& row) { return share_text(no_gathered_set_share(row)); }},
      total("sets", &SeedReprojection::sets),
      total("failed", &SeedReprojection::failed_sets),
      total("missing\nframes", &SeedReprojection::missing_frames)};
  return table_of(fields, results.rows);
}

// A row for each speed, a column for each desynchronisation.
Table curve_table(const std::vector<CurvePoint>& curve) {
  std::set<double> steps;
  for (const CurvePoint& point : curve) steps.insert(point.desync_ms);
  std::vector<Column> columns = {{"speed", Align::kLeft}};
  for (const double ms : steps) columns.push_back({fmt::format("{:g} ms", ms)});
  std::vector<std::string> speeds;
  std::map<std::string, std::map<double, double>> errors;
  for (const CurvePoint& point : curve) {
    const std::string speed = speed_text(point.speed_m_per_s, point.speed_factor);
    if (!errors.contains(speed)) speeds.push_back(speed);
    errors[speed][point.desync_ms] = evaluation::median(point.mean_cm);
  }
  Table table(columns);
  for (const std::string& speed : speeds) {
    std::vector<std::string> cells = {speed};
    for (const double ms : steps) {
      const auto found = errors[speed].find(ms);
      cells.push_back(found == errors[speed].end() ? "-" : cm_text(found->second));
    }
    table.add(cells);
  }
  return table;
}

std::string cost_text(const SyncLimit& limit) {
  return std::isnan(limit.cost_cm_per_ms) ? "-" : fmt::format("{:.4f}", limit.cost_cm_per_ms);
}

Table limits_table(const std::vector<SyncLimit>& limits) {
  const std::vector<Field<SyncLimit>> fields = {
      {{"speed", Align::kLeft},
       [](const auto& limit) { return speed_text(limit.speed_m_per_s, limit.speed_factor); }},
      {{"floor\ncm"}, [](const auto& limit) { return cm_text(limit.floor_cm); }},
      {{"desynchronisation\nup to, ms"}, limit_text},
      {{"cost there\ncm/ms"}, cost_text}};
  return table_of(fields, limits);
}

// "ntp_last_set : yoon2021_both = 3.21 [2.90, 3.94] in the mean error, seed by seed; published:
// 4.05."
std::string ratio_sentence(const PublishedRatio& ratio) {
  return fmt::format("{} : {} = {} in the mean error, seed by seed; published: {:.2f}.",
                     ratio.worst, ratio.best, cm_text(ratio.ratio), ratio.published);
}

Block conclusions(const ReconstructionResults& results) {
  Block block;
  if (const auto ratio = published_ratio(results.rows)) {
    block.prose.push_back(ratio_sentence(*ratio));
    if (results.scenario.draws_load()) {
      block.prose.push_back(fmt::format("But {}.", kOwnLoad));
    }
  }
  if (results.speed_needed) block.prose.push_back(speed_sentence(*results.speed_needed));
  return block;
}

Block row_notes(const ReconstructionResults& results) {
  Block block{.heading = "What went wrong", .is_warning = true};
  for (const ReprojectionRow& row : results.rows) {
    for (const std::string& note : row.notes) {
      block.items.push_back(fmt::format("{}: {}", row.pipeline, note));
    }
  }
  return block;
}

Block reconstruction_legend(const ReconstructionResults& results) {
  Block block{.heading = "How to read it", .items = {kErrorLegend, kDesyncLegend}};
  if (published_ratio(results.rows)) {
    block.items.push_back(
        fmt::format("published: the paper's Table 4, one recording. {}", placement_legend()));
  }
  if (!results.curve.empty()) block.items.emplace_back(kLimitLegend);
  return block;
}

constexpr const char* kErrorAxis = "median mean error, cm";

std::vector<FigureLine> published_lines(const ReconstructionResults& results, int first_colour) {
  std::vector<FigureLine> lines;
  for (const reconstruction::ReprojectionRow& row : results.rows) {
    if (!row.published) continue;
    lines.push_back(
        {.label = fmt::format("published {}: {}", row.pipeline, cm_text(row.published->mean_cm)),
         .at = row.published->mean_cm,
         .colour = first_colour + static_cast<int>(lines.size())});
  }
  return lines;
}

FigurePanel desync_panel(const ReconstructionResults& results) {
  FigurePanel panel{.title = "Reprojection error over desynchronisation",
                    .x_label = "desynchronisation of the hosts, ms",
                    .y_label = kErrorAxis};
  for (const CurvePoint& point : results.curve) {
    const std::string label = speed_text(point.speed_m_per_s, point.speed_factor);
    if (panel.series.empty() || panel.series.back().label != label) {
      const int colour = static_cast<int>(panel.series.size());
      panel.series.push_back({.label = label, .mark = Mark::kLine, .colour = colour});
    }
    panel.series.back().add(point.desync_ms, evaluation::median(point.mean_cm));
  }
  panel.lines = published_lines(results, static_cast<int>(panel.series.size()));
  return panel;
}

FigurePanel speed_panel(const reconstruction::SpeedNeeded& needed) {
  const bool walks = std::any_of(needed.points.begin(), needed.points.end(),
                                 [](const CurvePoint& point) { return point.speed_m_per_s > 0; });
  FigurePanel panel{
      .title = fmt::format("Reprojection error of {} ({} ms) over the subject's speed",
                           needed.pipeline, desync_text(needed.desync_ms)),
      .x_label = walks ? "walking speed, m/s" : "factor on the stated speed",
      .y_label = kErrorAxis,
      .lines = {{.label = fmt::format("published: {}", cm_text(needed.published_mean_cm)),
                 .at = needed.published_mean_cm}}};
  FigureSeries series{.label = needed.pipeline, .mark = Mark::kLine};
  for (const CurvePoint& point : needed.points) {
    series.add(walks ? point.speed_m_per_s : point.speed_factor, evaluation::median(point.mean_cm));
  }
  panel.series.push_back(std::move(series));
  return panel;
}

}  // namespace

std::vector<SyncLimit> sync_limits(const std::vector<CurvePoint>& curve) {
  std::vector<SyncLimit> limits;
  for (auto begin = curve.begin(); begin != curve.end();) {
    const auto end = std::find_if(begin, curve.end(), [&](const CurvePoint& point) {
      return point.speed_factor != begin->speed_factor;
    });
    limits.push_back(limit_of({begin, end}));
    begin = end;
  }
  return limits;
}

std::optional<PublishedRatio> published_ratio(const std::vector<ReprojectionRow>& rows) {
  const ReprojectionRow* worst = nullptr;
  const ReprojectionRow* best = nullptr;
  for (const ReprojectionRow& row : rows) {
    if (!row.published) continue;
    const double mean = row.published->mean_cm;
    if (worst == nullptr || mean > worst->published->mean_cm) worst = &row;
    if (best == nullptr || mean < best->published->mean_cm) best = &row;
  }
  if (worst == best) return std::nullopt;
  std::vector<double> ratios;
  for (const reconstruction::SeedReprojection& seed : worst->seeds) {
    ratios.push_back(seed.errors.mean_cm / mean_at(*best, seed.seed));
  }
  return PublishedRatio{.worst = worst->pipeline,
                        .best = best->pipeline,
                        .ratio = evaluation::make_series(std::move(ratios)),
                        .published = worst->published->mean_cm / best->published->mean_cm};
}

std::optional<double> speed_factor_for(const std::vector<CurvePoint>& points, double mean_cm) {
  const Curve curve = curve_of(points, &CurvePoint::speed_factor);
  if (curve.empty()) return std::nullopt;
  const std::size_t above = first_above(curve, mean_cm, 0);
  if (above == curve.size()) return std::nullopt;
  if (above == 0) return curve.front().x;
  return curve[above - 1].x + (mean_cm - curve[above - 1].y) / slope_before(curve, above);
}

std::string cm_text(double cm) { return std::isnan(cm) ? "-" : fmt::format("{:.2f}", cm); }

std::string cm_text(const evaluation::Series& series) {
  if (std::isnan(series.median)) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", series.median, series.p05, series.p95);
}

std::string desync_text(double ms) {
  if (std::isnan(ms)) return "-";
  return fmt::format("{:.{}f}", ms, std::abs(ms) < 1 ? 3 : 1);
}

std::string desync_text(const evaluation::Series& series) {
  if (std::isnan(series.median)) return "-";
  return fmt::format("{} [{}, {}]", desync_text(series.median), desync_text(series.p05),
                     desync_text(series.p95));
}

std::string speed_text(double speed_m_per_s, double speed_factor) {
  if (speed_m_per_s > 0) return fmt::format("{:.2f} m/s", speed_m_per_s);
  return fmt::format("x {:g}", speed_factor);
}

std::int64_t total_over_seeds(const ReprojectionRow& row, std::int64_t SeedReprojection::*member) {
  std::int64_t sum = 0;
  for (const SeedReprojection& seed : row.seeds) sum += seed.*member;
  return sum;
}

double no_gathered_set_share(const ReprojectionRow& row) {
  const auto without = std::count_if(row.seeds.begin(), row.seeds.end(),
                                     [](const auto& seed) { return !seed.gathered; });
  return row.seeds.empty() ? reconstruction::kNoError
                           : static_cast<double>(without) / static_cast<double>(row.seeds.size());
}

std::string limit_text(const SyncLimit& limit) {
  if (std::isnan(limit.floor_cm)) return "-";
  return limit.limit_ms ? desync_text(*limit.limit_ms) : fmt::format("> {:g}", limit.last_ms);
}

std::string speed_sentence(const reconstruction::SpeedNeeded& needed) {
  const std::string what =
      fmt::format("the published {} cm of {}, at its {} ms", cm_text(needed.published_mean_cm),
                  needed.pipeline, desync_text(needed.desync_ms));
  if (needed.points.empty()) return "";
  const CurvePoint& first = needed.points.front();
  const CurvePoint& last = needed.points.back();
  const double at_first = evaluation::median(first.mean_cm);
  if (at_first >= needed.published_mean_cm) {
    return fmt::format("At {} the error is {} cm already, which is more than {}.",
                       speed_phrase(first), cm_text(at_first), what);
  }
  if (needed.speed_m_per_s && *needed.speed_m_per_s > 0) {
    return fmt::format("For {}, the subject would have to move at {:.2f} m/s ({}).", what,
                       *needed.speed_m_per_s, points_text(needed.points));
  }
  if (const auto factor = speed_factor_for(needed.points, needed.published_mean_cm)) {
    return fmt::format("For {}, the subject would have to be {:.2f} times as fast as stated ({}).",
                       what, *factor, points_text(needed.points));
  }
  return fmt::format("No speed of the subject up to {} gives {}: it is {} cm there.",
                     speed_phrase(last), what, cm_text(evaluation::median(last.mean_cm)));
}

std::vector<std::string> honest_notes(const ReconstructionResults& results) {
  std::vector<std::string> notes;
  if (results.scenario.studio) {
    const Studio& studio = *results.scenario.studio;
    notes = {subject_note(studio.subject), assumptions_note(studio)};
    const std::string floor = floor_note(results.rows, studio.subject);
    if (!floor.empty()) notes.push_back(floor);
  }
  notes.insert(notes.end(), results.notes.begin(), results.notes.end());
  return notes;
}

Document reconstruction_document(const ReconstructionResults& results) {
  Document document{.title = title_line(results),
                    .head = paragraphs(reconstruction_answer(results))};
  if (!results.scenario.summary.empty()) document.head.push_back(results.scenario.summary);
  for (std::string& line : scenarios::derivation_lines(results.scenario.derivation)) {
    document.head.push_back(std::move(line));
  }
  std::vector<Block>& blocks = document.blocks;
  blocks.push_back({.heading = "Reprojection error", .table = table_4(results)});
  blocks.push_back({.heading = "The frame sets", .table = reconstructed_sets_table(results)});
  if (Block found = conclusions(results); !found.prose.empty()) blocks.push_back(std::move(found));
  if (!results.curve.empty()) {
    blocks.push_back({.heading = "Median mean error in cm, all hosts off by a known amount",
                      .table = curve_table(results.curve)});
    blocks.push_back({.heading = "How good must my synchronisation be for my subject?",
                      .table = limits_table(sync_limits(results.curve))});
  }
  if (Block notes = row_notes(results); !notes.items.empty()) blocks.push_back(std::move(notes));
  blocks.push_back(reconstruction_legend(results));
  blocks.push_back({.heading = "What was simulated", .items = honest_notes(results)});
  blocks.push_back(stages_block(results.rows));
  blocks.push_back({.prose = {fmt::format("Cost: {:.1f} s; {:.1f} s for a frame set on one thread.",
                                          results.wall_s, results.seconds_per_set)}});
  return document;
}

Figure reconstruction_figure(const ReconstructionResults& results) {
  Figure figure;
  figure.id = "reconstruction";
  figure.title = fmt::format("{}: what desynchronisation costs", results.scenario.name);
  figure.source = {.scenario = results.scenario.name,
                   .derivation = results.scenario.derivation,
                   .pipeline = results.rows.size() == 1 ? results.rows.front().pipeline : "",
                   .first_seed = results.first_seed,
                   .seeds = results.seeds};
  figure.caption = fmt::format(
      "Over desynchronisation: all hosts off by a known amount, exposures of a host's cameras "
      "coincide, the hosts are spread over it. Over speed: the exposures that the pipeline has. "
      "Medians over {}.",
      counted(results.seeds, "seed"));
  if (!results.curve.empty()) figure.panels.push_back(desync_panel(results));
  if (results.speed_needed && !results.speed_needed->points.empty()) {
    figure.panels.push_back(speed_panel(*results.speed_needed));
  }
  if (figure.panels.empty()) figure.absent = "the curve was not requested";
  return figure;
}

}  // namespace simbench::reports
