#include "reconstruction/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "algorithms/ports/stage.h"
#include "evaluation/run/exposure_sets.h"
#include "evaluation/run/jobs.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/statistics/statistics.h"
#include "reconstruction/desync_pattern.h"
#include "reconstruction/libraries/mesh_file.h"
#include "reconstruction/libraries/picture.h"
#include "reconstruction/libraries/quiet_errors.h"
#include "reconstruction/libraries/set_reconstruction.h"
#include "reconstruction/subject.h"
#include "scenarios/loader.h"
#include "sim/engine/random.h"

namespace simbench::reconstruction {
namespace {

using evaluation::ExposureSet;
using evaluation::ExposureSets;
using evaluation::PipelineChoice;
using scenarios::Scenario;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Makes the subject that a scenario's studio states, following its script at any speed. Reads a
// mesh file once.
class SubjectMaker {
 public:
  // Throws scenarios::InputError for a mesh file that cannot be used.
  explicit SubjectMaker(const scenarios::StudioSubject& subject) : subject_(subject) {
    if (subject.kind == scenarios::SubjectKind::kMesh) {
      loaded_ = load_subject_mesh(subject.mesh_file);
    }
  }
  std::unique_ptr<Subject> make(double speed_factor) const {
    return loaded_ ? make_rigid_subject(loaded_->mesh, subject_, speed_factor)
                   : make_person(subject_, speed_factor);
  }
  // Notes about the mesh file for its user.
  std::vector<std::string> notes() const {
    return loaded_ ? loaded_->notes : std::vector<std::string>{};
  }

 private:
  scenarios::StudioSubject subject_;
  std::optional<LoadedMesh> loaded_;
};

class Experiment {
 public:
  Experiment(const Scenario& scenario, const evaluation::SourceFactory& make_source,
             const ReconstructionOptions& options, const MeshKeeper& on_mesh,
             const evaluation::Progress& progress)
      : scenario_(scenario),
        make_source_(make_source),
        options_(options),
        on_mesh_(on_mesh),
        progress_(progress),
        choices_(evaluation::choose_pipelines(scenario, options.pipelines)),
        subjects_(studio_of(scenario).subject),
        subject_(subjects_.make(1.0)) {
    refuse_unseen_subject();
  }

  ReconstructionResults run() {
    const double begin = now_s();
    results_.scenario = scenario_;
    results_.first_seed = options_.first_seed;
    results_.seeds = options_.seeds;
    results_.frames = options_.frames;
    results_.notes = subjects_.notes();
    name_rows();
    count_sets();
    make_rows();
    results_.curve = curve();
    if (searches()) search_speed();
    results_.wall_s = now_s() - begin;
    results_.seconds_per_set = done_ > 0 ? set_seconds_ / static_cast<double>(done_) : 0;
    return std::move(results_);
  }

 private:
  static const scenarios::Studio& studio_of(const Scenario& scenario) {
    const StudioRig checked(scenario, 1);  // throws InputError without a studio
    return *scenario.studio;
  }

  void refuse_unseen_subject() const {
    SetReconstruction studio(scenario_, *subject_, options_.first_seed);
    for (std::size_t camera = 0; camera < static_cast<std::size_t>(scenario_.cameras.count);
         ++camera) {
      const DepthMap seen = studio.measure(camera, {});
      if (std::any_of(seen.depth_m.begin(), seen.depth_m.end(), [](float z) { return z > 0; })) {
        return;
      }
    }
    scenarios::fail_at(
        scenario_, "/studio/subject",
        "found a subject that no camera sees; allowed: one within the cameras' view "
        "(radius_m, look_at_height_m) and between min_distance_m and max_distance_m");
  }

  void count_sets() {
    const auto seeds = static_cast<std::int64_t>(options_.seeds);
    const auto size = [](const auto& list) { return static_cast<std::int64_t>(list.size()); };
    total_ = size(choices_) * row_sets();
    total_ += seeds * options_.curve_frames * size(options_.curve_speed_factors) *
              size(options_.curve_desync_ms);
    if (searches()) total_ += row_sets() * size(searched(true));
  }

  std::int64_t row_sets() const {
    return static_cast<std::int64_t>(options_.seeds) * options_.frames;
  }

  void run_all(std::size_t count, const std::function<void(std::size_t)>& job) {
    const evaluation::JobOptions options{.threads = options_.jobs, .cancel = options_.cancel};
    if (!evaluation::run_jobs(count, options, job)) {
      throw ReconstructionCancelled("cancelled");
    }
  }

  // Throws between the sets of a job: a job that returned early would count as done.
  void stop_if_cancelled() const {
    if (options_.cancel != nullptr && options_.cancel->load()) {
      throw ReconstructionCancelled("cancelled");
    }
  }

  void name_rows() {
    for (const PipelineChoice& choice : choices_) {
      ReprojectionRow row;
      row.pipeline = choice.pipeline.name;
      copy_stages(choice.pipeline, row);
      const auto published = scenario_.studio->published.find(row.pipeline);
      if (published != scenario_.studio->published.end()) row.published = published->second;
      results_.rows.push_back(std::move(row));
    }
  }

  void make_rows() {
    std::vector<SeedReprojection> found(choices_.size() * options_.seeds);
    std::vector<std::string> failures(found.size());
    // All pipelines of a seed, then the next seed: so the time left follows from the time elapsed.
    run_all(found.size(), [&](std::size_t job) {
      found[job] = run_seed(job % choices_.size(), options_.first_seed + job / choices_.size(), 1,
                            failures[job]);
    });
    for (std::size_t job = 0; job < found.size(); ++job) {
      ReprojectionRow& row = results_.rows[job % choices_.size()];
      row.seeds.push_back(found[job]);
      if (!failures[job].empty()) row.notes.push_back(failures[job]);
    }
  }

  SeedReprojection run_seed(std::size_t pipeline, std::uint64_t seed, double speed_factor,
                            std::string& failure) {
    const std::unique_ptr<RecordingSource> source = make_source_();
    ExposureSets sets;
    try {
      sets = evaluation::exposure_sets(scenario_, choices_[pipeline], seed, *source,
                                       static_cast<std::size_t>(options_.frames));
    } catch (const RecordingFailed& error) {
      failure = fmt::format("seed {}: {}", seed, error.what());
    }
    const std::unique_ptr<Subject> other =
        speed_factor == 1 ? nullptr : subjects_.make(speed_factor);
    SetReconstruction studio(scenario_, other ? *other : *subject_, seed);
    SeedTally tally;
    for (std::size_t i = 0; i < sets.sets.size(); ++i) {
      stop_if_cancelled();
      const bool shown = !other && seed == options_.first_seed && i == 0;
      add_set(studio, sets.sets[i], tally, shown ? &results_.rows[pipeline].pipeline : nullptr);
    }
    return tally.finish(seed, sets.gathered_sets > 0);
  }

  // `shown`: the pipeline whose mesh this is, if it is to be shown.
  void add_set(SetReconstruction& studio, const ExposureSet& set, SeedTally& tally,
               const std::string* shown) {
    const double begin = now_s();
    ErrorStatistics own;
    const std::optional<ScoredSurface> surface = studio.reconstruct(set, own);
    tally.add(set, surface.has_value(), own);
    const double seconds = now_s() - begin;
    if (shown != nullptr && surface && on_mesh_) show(*shown, *surface, set, own.summary());
    const std::lock_guard lock(mutex_);
    set_seconds_ += seconds;
    ++done_;
    if (progress_) {
      progress_(static_cast<std::uint64_t>(done_), static_cast<std::uint64_t>(total_));
    }
  }

  void show(const std::string& pipeline, const ScoredSurface& surface, const ExposureSet& set,
            const ErrorSummary& errors) {
    ShownMesh shown{.pipeline = pipeline,
                    .mesh = surface.mesh,
                    .ply = {},
                    .png = {},
                    .desync_ms = set.spread_ms(),
                    .errors = errors};
    shown.mesh.colours = error_colours(surface.by_vertex);
    shown.ply = ply_bytes(shown.mesh);
    shown.png = png_bytes(picture_of(shown.mesh));
    const std::lock_guard lock(mutex_);
    on_mesh_(shown);
  }

  CurvePoint empty_point(double speed_factor, double desync_ms) const {
    return {.speed_m_per_s = scenario_.studio->subject.walk_speed_m_per_s * speed_factor,
            .speed_factor = speed_factor,
            .desync_ms = desync_ms,
            .mean_cm = std::vector<double>(options_.seeds, kNoError),
            .std_cm = std::vector<double>(options_.seeds, kNoError)};
  }

  // The points of every speed and desynchronisation.
  std::vector<CurvePoint> curve() {
    std::vector<CurvePoint> points;
    for (const double factor : options_.curve_speed_factors) {
      for (const double desync_ms : options_.curve_desync_ms) {
        points.push_back(empty_point(factor, desync_ms));
      }
    }
    run_all(points.size() * options_.seeds, [&](std::size_t job) {
      CurvePoint& point = points[job / options_.seeds];
      const std::size_t seed = job % options_.seeds;
      const SeedReprojection found = run_point(point, options_.first_seed + seed);
      point.mean_cm[seed] = found.errors.mean_cm;
      point.std_cm[seed] = found.errors.std_cm;
    });
    return points;
  }

  SeedReprojection run_point(const CurvePoint& point, std::uint64_t seed) {
    const std::unique_ptr<Subject> subject = subjects_.make(point.speed_factor);
    SetReconstruction studio(scenario_, *subject, seed);
    SeedTally tally;
    for (std::int64_t i = 0; i < options_.curve_frames; ++i) {
      stop_if_cancelled();
      const auto index = static_cast<std::uint32_t>(i);
      constexpr double kWithin = 60;  // s
      const double at_s = sim::RandomStream(seed, "desync instant", index).uniform(0, kWithin);
      add_set(studio, desynchronised_set(scenario_, seed, point.desync_ms, at_s, index), tally,
              nullptr);
    }
    return tally.finish(seed, false);
  }

  std::optional<std::size_t> worst_published() const {
    std::optional<std::size_t> worst;
    for (std::size_t i = 0; i < results_.rows.size(); ++i) {
      const auto& published = results_.rows[i].published;
      if (!published) continue;
      if (!worst || published->mean_cm > results_.rows[*worst].published->mean_cm) worst = i;
    }
    return worst;
  }

  bool searches() const {
    return !options_.search_speed_factors.empty() && worst_published().has_value();
  }

  // The searched factors above 1, or those below, outward from 1.
  std::vector<double> searched(bool faster) const {
    std::vector<double> factors;
    for (const double factor : options_.search_speed_factors) {
      if (faster ? factor > 1 : factor < 1) factors.push_back(factor);
    }
    std::sort(factors.begin(), factors.end(),
              [&](double a, double b) { return faster ? a < b : a > b; });
    return factors;
  }

  // Finds the speed at which the row with the largest published mean reaches it: runs the row's own
  // exposures with a faster and faster (or slower) subject until the published error is passed.
  void search_speed() {
    const std::size_t worst = *worst_published();
    const ReprojectionRow& row = results_.rows[worst];
    SpeedNeeded needed{.pipeline = row.pipeline,
                       .desync_ms = row.desync_ms().median,
                       .published_mean_cm = row.published->mean_cm,
                       .points = {},
                       .speed_m_per_s = {}};
    needed.points.push_back(point_of(row.seeds, 1, needed.desync_ms));
    const double stated_cm = evaluation::median(needed.points[0].mean_cm);
    const bool faster = stated_cm < needed.published_mean_cm;
    std::vector<double> factors = searched(faster);
    if (std::isnan(stated_cm)) factors.clear();
    total_ = done_ + row_sets() * static_cast<std::int64_t>(factors.size());
    for (const double factor : factors) {
      needed.points.push_back(point_of(run_at_speed(worst, factor), factor, needed.desync_ms));
      const double here_cm = evaluation::median(needed.points.back().mean_cm);
      if ((here_cm < needed.published_mean_cm) != faster) break;
    }
    if (progress_) {
      progress_(static_cast<std::uint64_t>(done_), static_cast<std::uint64_t>(done_));
    }
    if (!faster) std::reverse(needed.points.begin(), needed.points.end());
    needed.speed_m_per_s = first_passing(needed.points, needed.published_mean_cm);
    if (!std::isnan(stated_cm)) results_.speed_needed = std::move(needed);
  }

  std::vector<SeedReprojection> run_at_speed(std::size_t pipeline, double factor) {
    std::vector<SeedReprojection> found(options_.seeds);
    run_all(found.size(), [&](std::size_t seed) {
      std::string failure;  // noted in the row
      found[seed] = run_seed(pipeline, options_.first_seed + seed, factor, failure);
    });
    return found;
  }

  CurvePoint point_of(const std::vector<SeedReprojection>& seeds, double factor,
                      double desync_ms) const {
    CurvePoint point = empty_point(factor, desync_ms);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      point.mean_cm[i] = seeds[i].errors.mean_cm;
      point.std_cm[i] = seeds[i].errors.std_cm;
    }
    return point;
  }

  // The speed at which the median mean error first reaches `mean_cm`, linear between the points.
  static std::optional<double> first_passing(const std::vector<CurvePoint>& points,
                                             double mean_cm) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double here = evaluation::median(points[i].mean_cm);
      if (!(here >= mean_cm)) continue;
      if (i == 0) return points[0].speed_m_per_s;
      const double before = evaluation::median(points[i - 1].mean_cm);
      const double share = (mean_cm - before) / (here - before);
      return points[i - 1].speed_m_per_s +
             share * (points[i].speed_m_per_s - points[i - 1].speed_m_per_s);
    }
    return std::nullopt;
  }

  const Scenario& scenario_;
  const evaluation::SourceFactory& make_source_;
  const ReconstructionOptions& options_;
  const MeshKeeper& on_mesh_;
  const evaluation::Progress& progress_;
  std::vector<PipelineChoice> choices_;
  SubjectMaker subjects_;
  std::unique_ptr<Subject> subject_;
  ReconstructionResults results_;
  std::int64_t total_ = 0;
  std::mutex mutex_;  // guards what follows, and calls of on_mesh_ and progress_
  std::int64_t done_ = 0;
  double set_seconds_ = 0;
};

}  // namespace

ReconstructionResults run_reconstruction(const Scenario& scenario,
                                         const evaluation::SourceFactory& make_source,
                                         const ReconstructionOptions& options,
                                         const MeshKeeper& on_mesh,
                                         const evaluation::Progress& progress) {
  const QuietErrors quiet;
  return Experiment(scenario, make_source, options, on_mesh, progress).run();
}

}  // namespace simbench::reconstruction
