#include "reports/archive/archive.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "algorithms/ports/assert.h"
#include "algorithms/ports/stage.h"
#include "evaluation/clock_run/clock_score.h"
#include "recording/collected.h"
#include "recording/line_reader.h"
#include "recording/number_in.h"
#include "recording/version.h"
#include "reports/results/csv.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/json.h"
#include "reports/text/json_node.h"
#include "reports/text/program_name.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

std::string utc_text(std::chrono::system_clock::time_point time) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(time - whole).count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(whole)), ms);
}

bool is_plain(char letter) {
  constexpr std::string_view kPlain = "_-./=,:+@%";
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
         kPlain.find(letter) != std::string_view::npos;
}

std::string shell_quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string text = "'";
  for (const char letter : word) {
    if (letter == '\'') {
      text += "'\\''";
    } else {
      text += letter;
    }
  }
  text += '\'';
  return text;
}

}  // namespace

std::string shell_line(const std::vector<std::string>& words) {
  const std::vector<std::string> all = collected(words, shell_quoted);
  return fmt::format("{}", fmt::join(all, " "));
}

std::string simbench_line(std::vector<std::string> command) {
  command.front() = program_name();
  return shell_line(command);
}

std::string manifest_json(const Provenance& provenance, const Json& more) {
  Json manifest = {{"schema_version", kArchiveSchemaVersion},
                   {"program", "simbench"},
                   {"version", version()},
                   {"commit", commit()},
                   {"command", provenance.command},
                   {"started", utc_text(provenance.started)},
                   {"finished", utc_text(provenance.finished)}};
  manifest.update(more);
  return file_text(manifest);
}

std::string manifest_json(const Provenance& provenance, const evaluation::Results& results,
                          const scenarios::Scenario& scenario) {
  const bool is_of_clocks = results.kind == evaluation::ResultKind::kClockRuns;
  Json more;
  if (is_of_clocks) more["kind"] = kClockRunsName;
  more["seeds"] = {{"first", results.first_seed}, {"count", results.seed_count}};
  if (is_of_clocks) {
    more["duration_s"] = results.clock_period.duration_s;
    more["from_s"] = results.clock_period.from_s;
  }
  more["pipelines"] = Json::array();
  for (const evaluation::Row& row : results.rows) more["pipelines"].push_back(row.pipeline);
  state_derivation(results.derivation, more);
  more["scenario"] = Json::parse(scenario.resolved_json());
  return manifest_json(provenance, more);
}

void write_archive_files(OutputFolder& output, const std::string& prefix,
                         const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const Provenance& provenance, const ResultsAnswer* answer) {
  output.file(prefix + kManifest) << manifest_json(provenance, results, scenario);
  output.file(prefix + "results.json")
      << (answer == nullptr ? json(results) : json(results, *answer));
  write_frames_csv(results, output.file(prefix + "frames.csv"));
  write_hosts_csv(results, output.file(prefix + "hosts.csv"));
}

void write_archive(OutputFolder& output, const evaluation::Results& results,
                   const scenarios::Scenario& scenario, const Provenance& provenance,
                   const ResultsAnswer* answer) {
  write_archive_files(output, "", results, scenario, provenance, answer);
  output.publish();
}

Archive kept_archive(const std::string& path, const evaluation::Results& results,
                     const scenarios::Scenario& scenario, const Provenance& provenance) {
  return {.path = path,
          .command = provenance.command,
          .started = utc_text(provenance.started),
          .finished = utc_text(provenance.finished),
          .scenario_json = scenario.resolved_json(),
          .results = results};
}

evaluation::ResultKind read_result_kind(const JsonNode& root, const char* member) {
  if (!root.has(member)) return evaluation::ResultKind::kCaptures;
  const JsonNode kind = root[member];
  if (kind.text() != kClockRunsName) {
    kind.refuse(fmt::format("\"{}\", or no member \"{}\"", kClockRunsName, member));
  }
  return evaluation::ResultKind::kClockRuns;
}

evaluation::ClockPeriod read_clock_period(const JsonNode& root, evaluation::ResultKind kind) {
  if (kind != evaluation::ResultKind::kClockRuns) return {};
  return {.from_s = static_cast<std::uint64_t>(root["from_s"].count()),
          .duration_s = static_cast<std::uint64_t>(root["duration_s"].count())};
}

namespace {

using evaluation::Row;

constexpr const char* kAdvice =
    "`simbench run --output DIR` (and `clocks`) writes a result archive, and `simbench run "
    "--format json > FILE` "
    "a result without one";

std::vector<std::string> read_lines(const JsonNode& list) {
  std::vector<std::string> lines;
  for (const JsonNode& line : list.elements()) lines.push_back(line.text());
  return lines;
}

evaluation::Percentile percentile(const JsonNode& published, const char* name) {
  const JsonNode interval = published[fmt::format("{}_interval", name).c_str()];
  const std::vector<JsonNode> ends = interval.elements();
  if (ends.size() != 2) interval.refuse("two numbers");
  return {published[name].number(), ends[0].number(), ends[1].number()};
}

std::optional<evaluation::PublishedComparison> published(const JsonNode& node) {
  if (node.is_null()) return std::nullopt;
  return evaluation::PublishedComparison{.amd_ms = node["amd_ms"].number(),
                                         .rmdv_ms = node["rmdv_ms"].number(),
                                         .rmdv_attainable = node["rmdv_attainable"].flag(),
                                         .amd_percentile = percentile(node, "amd_percentile"),
                                         .rmdv_percentile = percentile(node, "rmdv_percentile")};
}

// Archives from before the first release lack these members: all are of simulations.
void read_ground_truth(const JsonNode& node, Row& row) {
  if (!node.has("ground_truth")) return;
  using evaluation::GroundTruth;
  const JsonNode name = node["ground_truth"];
  const std::string text = name.text();
  bool known = false;
  for (const GroundTruth truth :
       {GroundTruth::kSimulation, GroundTruth::kGenlockOrder, GroundTruth::kNone}) {
    if (text != ground_truth_name(truth)) continue;
    row.ground_truth = truth;
    known = true;
  }
  if (!known) name.refuse("\"simulation\", \"genlock_order\" or \"none\"");
  for (const JsonNode& note : node["notes"].elements()) row.notes.push_back(note.text());
}

void read_metric(const JsonNode& row_node, std::size_t seeds, const evaluation::Metric& metric,
                 Row& row) {
  if (metric.is_count() && metric.is_new && !row_node[metric.json_in].has(metric.member())) return;
  if (metric.is_new && !metric.is_count() && !row_node.has(metric.member())) {
    metric.series(row) = evaluation::make_series(std::vector<double>(seeds, evaluation::kNan));
    return;
  }
  const JsonNode node = *metric.json_in == '\0' ? row_node[metric.member()]
                                                : row_node[metric.json_in][metric.member()];
  if (metric.is_series()) {
    metric.series(row) = evaluation::make_series(node["values"].values_of(metric, seeds));
  } else if (!metric.is_count()) {
    metric.number(row) = node.value_of(metric);
  } else if (metric.needs == evaluation::Needs::kNothing || !node.is_null()) {
    metric.count(row) = node.count();
  }
}

Row read_stages(const JsonNode& node) {
  Row row;
  row.pipeline = node["pipeline"].text();
  for (const StageInfo& stage : kPipelineStages) {
    if (stage.may_be_absent && !node.has(stage.name)) continue;
    at_stage(row, stage.id) = node[stage.name].text();
  }
  if (node.has("model")) row.model = node["model"].text();
  return row;
}

PlaceSearch read_search(const JsonNode& node) {
  const auto whole = [&node](const char* member) {
    return static_cast<std::uint32_t>(node[member].count());
  };
  return {.sources = whole("sources"),
          .found = whole("found"),
          .again = whole("again"),
          .frames = whole("frames"),
          .seconds = node["seconds"].number(),
          .since_first_frame_s = node["since_first_frame_s"].number(),
          .error_probability = node["error_probability"].number()};
}

Row read_row(const JsonNode& node, std::size_t seeds) {
  Row row = read_stages(node);
  row.offline = node["offline"].flag();
  for (const evaluation::Metric& metric : evaluation::metrics()) {
    read_metric(node, seeds, metric, row);
  }
  row.published = published(node["published"]);
  read_ground_truth(node, row);
  if (node.has("search")) row.search = read_search(node["search"]);
  read_programs(node, row);
  return row;
}

// A row of `simbench clocks` (reports/clocks/clock_report.h): its metrics alone.
Row read_clock_row(const JsonNode& node, std::size_t seeds) {
  Row row = read_stages(node);
  for (const evaluation::Metric& metric : evaluation::metrics(evaluation::ResultKind::kClockRuns)) {
    const JsonNode values = node["metrics"][metric.id]["values"];
    metric.series(row) = evaluation::make_series(values.values_of(metric, seeds));
  }
  if (node.has("unsynchronised_hosts")) {
    row.unsynchronised_hosts = node["unsynchronised_hosts"].count();
  }
  if (node.has("notes")) row.notes = read_lines(node["notes"]);
  read_programs(node, row);
  return row;
}

evaluation::StabilityCurves read_curves(const JsonNode& row) {
  evaluation::StabilityCurves curves;
  for (const evaluation::ClockCurve& curve : evaluation::clock_curves()) {
    for (const JsonNode& point : row[curve.id].elements()) {
      const double tau_s = point["tau_s"].number();
      const double value = point["value"].number();
      if (!(tau_s > 0)) point["tau_s"].refuse("a number above 0");
      if (!(value >= 0)) point["value"].refuse("a number from 0");
      (curves.*curve.points)
          .push_back({.tau_s = tau_s, .value = value, .terms = point["terms"].count()});
    }
  }
  return curves;
}

evaluation::Claim read_claim(const JsonNode& node, std::uint64_t seeds) {
  evaluation::Claim claim;
  claim.id = node["id"].text();
  claim.text = node["text"].text();
  if (!node["holds_fraction"].is_null()) claim.holds_fraction = node["holds_fraction"].number();
  if (!node["needs"].is_null()) claim.needs = node["needs"].text();
  claim.decided_seeds = claim.holds_fraction ? seeds : 0;  // before the first release
  if (node.has("decided_seeds")) {
    claim.decided_seeds = static_cast<std::uint64_t>(node["decided_seeds"].count());
  }
  return claim;
}

// The published figures, the claims and the floor of captures.
void read_paper_part(const JsonNode& root, evaluation::Results& results) {
  results.published_figures = read_published_figures(root, results.rows);
  for (const JsonNode& claim : root["claims"].elements()) {
    results.claims.push_back(read_claim(claim, results.seed_count));
  }
  if (const JsonNode floor = root["asymmetry_floor"]; !floor.is_null()) {
    results.asymmetry_floor =
        evaluation::AsymmetryFloor{.sigma_ms = floor["sigma_ms"].number(),
                                   .host_error_ms = floor["host_error_ms"].number(),
                                   .amd_ms = floor["amd_ms"].number()};
  }
}

// Archives from before the first release lack the member: steered exposures and clocks rank as now.
evaluation::RankedBy read_ranked_by(const JsonNode& root, const evaluation::Results& results) {
  using evaluation::RankedBy;
  if (results.kind == evaluation::ResultKind::kClockRuns) return RankedBy::kClockSpread;
  if (!root.has(kRankedByMember)) {
    const bool is_steered = std::ranges::any_of(
        results.rows, [](const Row& row) { return !row.capture_alignment.empty(); });
    return is_steered ? RankedBy::kExposureSpread : RankedBy::kAmd;
  }
  const std::optional<RankedBy> named = evaluation::ranked_by_named(root[kRankedByMember].text());
  if (!named) {
    root[kRankedByMember].refuse(
        fmt::format("one of {}", fmt::join(evaluation::ranking_metrics(), ", ")));
  }
  return *named;
}

evaluation::Results read_results(const JsonNode& root) {
  evaluation::Results results;
  results.kind = read_result_kind(root, "kind");
  results.clock_period = read_clock_period(root, results.kind);
  const bool is_of_clocks = results.kind == evaluation::ResultKind::kClockRuns;
  results.scenario = root["scenario"].text();
  results.derivation = read_derivation(root);
  results.draws_load = root.has(kOwnLoadMember) && root[kOwnLoadMember].flag();
  results.first_seed = static_cast<std::uint64_t>(root["seeds"]["first"].count());
  results.seed_count = static_cast<std::uint64_t>(root["seeds"]["count"].count());
  for (const JsonNode& row : root["rows"].elements()) {
    results.rows.push_back(is_of_clocks ? read_clock_row(row, results.seed_count)
                                        : read_row(row, results.seed_count));
  }
  results.ranked_by = read_ranked_by(root, results);
  if (!is_of_clocks) read_paper_part(root, results);
  results.warnings = read_lines(root["warnings"]);
  if (root.has(kLossReasonsMember)) results.loss_reasons = read_lines(root[kLossReasonsMember]);
  if (root.has(kLoadRealityMember)) results.load_reality = read_lines(root[kLoadRealityMember]);
  const JsonNode cost = root["performance"];
  results.performance = {
      .events = static_cast<std::uint64_t>(cost["events"].count()),
      .simulated_seconds = cost["simulated_seconds"].number(),
      .cpu_seconds = cost["cpu_seconds"].number(),
      .wall_seconds = cost["wall_seconds"].number(),
      .events_per_second = cost["events_per_second"].number(),
      .simulated_seconds_per_second = cost["simulated_seconds_per_second"].number()};
  return results;
}

void read_manifest(const JsonFile& file, Archive& archive) {
  const JsonNode root(file, file.value);
  root.check_schema_version(kArchiveSchemaVersion);
  for (const JsonNode& word : root["command"].elements()) archive.command.push_back(word.text());
  archive.started = root["started"].text();
  archive.finished = root["finished"].text();
  archive.scenario_json = root["scenario"].dump();
  if (const JsonNode name = root["scenario"]["name"]; name.text() != archive.results.scenario) {
    name.refuse(fmt::format("'{}', as in results.json beside it", archive.results.scenario));
  }
}

}  // namespace

bool is_of_files(const Archive& archive) {
  return !archive.scenario_json.empty() &&
         Json::parse(archive.scenario_json).contains(kRecordingMember);
}

Archive read_archive(const std::string& path) {
  const bool is_folder = std::filesystem::is_directory(path);
  const std::filesystem::path folder = path;
  const JsonFile file =
      read_json_file(is_folder ? (folder / "results.json").string() : path, kAdvice);
  const JsonNode root(file, file.value);
  root.check_schema_version(kArchiveSchemaVersion);
  Archive archive;
  archive.path = path;
  archive.version = root["version"].text();
  archive.commit = root["commit"].text();
  archive.results = read_results(root);
  if (archive.results.kind == evaluation::ResultKind::kClockRuns) {
    for (const JsonNode& row : root["rows"].elements()) archive.curves.push_back(read_curves(row));
  }
  if (is_folder) {
    read_manifest(read_json_file((folder / "manifest.json").string(), kAdvice), archive);
  }
  return archive;
}

namespace {

using evaluation::SeedScore;

constexpr std::size_t kMostCells = 11;    // of a line, before those of a changed world
constexpr std::size_t kSessionCells = 5;  // from there on hosts.csv has the delays of sessions
constexpr double kLongestMs = 1e9;        // of a delay

LineReader lines_of_archive(const std::string& path) {
  try {
    return LineReader(path);
  } catch (const LineError& error) {
    throw scenarios::InputError(
        fmt::format("{}; only the folder of an archive has it", error.what()));
  }
}

// One of the archive's CSV files, line by line. The first cell may be quoted (RFC 4180).
class CsvFile {
 public:
  // `headers`: the present one first, then those of older archives.
  CsvFile(const Archive& archive, const char* name, std::initializer_list<std::string_view> headers)
      : lines_(lines_of_archive((std::filesystem::path(archive.path) / name).string())) {
    const bool found = next();
    const auto* const stated = std::ranges::find_if(headers, [this](std::string_view header) {
      changed_ = line_ == std::string(header) + ",changed";
      return changed_ || line_ == header;
    });
    if (!found || stated == headers.end()) {
      fail(fmt::format("line 1 has to be '{}', of a changed world with ',changed'",
                       *headers.begin()));
    }
    size_ = static_cast<std::size_t>(std::ranges::count(*stated, ',')) + 1;
    SIMBENCH_ASSERT(size_ <= kMostCells, "there is a place for each cell");
  }

  // Splits the next line, which must have a cell for each of the header, and of a changed world the
  // changes; false at the end.
  bool next_row() {
    if (!next()) return false;
    std::string_view rest = line_;
    name_ = take_name(rest);
    for (std::size_t i = 1; i < size_; ++i) {
      const std::size_t comma = rest.find(',');
      const bool last = i == size_ - 1 && !changed_;
      if ((comma == std::string_view::npos) != last) {
        fail(fmt::format("allowed: exactly {} cells; was the file cut short?",
                         size_ + (changed_ ? 1 : 0)));
      }
      cells_[i] = rest.substr(0, comma);
      rest.remove_prefix(last ? rest.size() : comma + 1);
    }
    if (changed_ && rest != changes_.value_or(std::string(rest))) {
      fail(fmt::format("found '{}', allowed: '{}', the changes of all lines",
                       scenarios::shown_text(rest), scenarios::shown_text(*changes_)));
    }
    if (!changes_) changes_ = rest;
    return true;
  }

  std::size_t size() const { return size_; }
  const std::string& name() const { return name_; }
  std::string_view text(std::size_t cell) const { return cells_[cell]; }
  template <class Number>
  Number number(std::size_t cell) const {
    if (const std::optional<Number> value = number_in<Number>(cells_[cell])) return *value;
    fail(fmt::format("found '{}', allowed: a number", scenarios::shown_text(cells_[cell])));
  }
  // An empty cell is NaN.
  double value(std::size_t cell) const {
    return cells_[cell].empty() ? evaluation::kNan : number<double>(cell);
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw scenarios::InputError(fmt::format("{}: {}", lines_.place(), problem));
  }

 private:
  bool next() {
    std::optional<std::string_view> line;
    try {
      line = lines_.next();
    } catch (const LineError& error) {
      throw scenarios::InputError(error.what());
    }
    if (!line && lines_.torn()) fail("found no end of the line; was the file cut short?");
    line_ = line.value_or("");
    return line.has_value();
  }

  // The first cell, without its quotes; leaves what follows the comma.
  static std::string take_name(std::string_view& rest) {
    std::string name;
    bool quoted = false;
    std::size_t i = 0;
    for (; i < rest.size() && (quoted || rest[i] != ','); ++i) {
      if (rest[i] != '"') {
        name += rest[i];
      } else if (quoted && i + 1 < rest.size() && rest[i + 1] == '"') {
        name += rest[++i];
      } else {
        quoted = !quoted;
      }
    }
    rest.remove_prefix(std::min(i + 1, rest.size()));
    return name;
  }

  LineReader lines_;
  std::string_view line_;
  std::string name_;
  std::string_view cells_[kMostCells];
  std::size_t size_ = 0;
  bool changed_ = false;
  std::optional<std::string> changes_;
};

// The score for a line, which begins with pipeline and seed. `row`: that of the line before, or
// null; mostly the same.
SeedScore& score_of(const CsvFile& file, evaluation::Results& results, Row*& row) {
  const auto seed = file.number<std::uint64_t>(1);
  if (seed < results.first_seed || seed - results.first_seed >= results.seed_count) {
    file.fail(fmt::format("found seed {}, allowed: {} to {}, the seeds of results.json", seed,
                          results.first_seed, results.first_seed + results.seed_count - 1));
  }
  if (row == nullptr || row->pipeline != file.name()) {
    const auto found = std::find_if(results.rows.begin(), results.rows.end(),
                                    [&](const Row& r) { return r.pipeline == file.name(); });
    if (found == results.rows.end()) {
      file.fail(fmt::format("found pipeline '{}', which results.json does not have",
                            scenarios::shown_text(file.name())));
    }
    row = &*found;
  }
  return row->seeds[seed - results.first_seed];
}

// The delays of a line of hosts.csv; nothing of a host without a session.
std::optional<SessionDelays> session_of(const CsvFile& hosts) {
  if (hosts.size() == kSessionCells || hosts.text(kSessionCells).empty()) return std::nullopt;
  const auto delay = [&hosts](std::size_t place) {
    const auto ms = hosts.number<double>(kSessionCells + place);
    if (std::abs(ms) <= kLongestMs) return from_ms(ms);
    hosts.fail(fmt::format("found {} ms, allowed: at most {} either way", ms, kLongestMs));
  };
  return SessionDelays{.slave = hosts.number<PeerId>(2),
                       .pass = hosts.number<std::uint32_t>(kSessionCells + 3),
                       .t_l = delay(0),
                       .t_t = delay(1),
                       .t_d = delay(2),
                       .get = delay(4),
                       .set = delay(5)};
}

}  // namespace

void read_seed_details(Archive& archive) {
  evaluation::Results& results = archive.results;
  for (Row& each : results.rows) {
    each.seeds.assign(results.seed_count, SeedScore{});
    for (std::size_t i = 0; i < each.seeds.size(); ++i) each.seeds[i].seed = results.first_seed + i;
  }
  CsvFile frames(archive, "frames.csv",
                 {"pipeline,seed,pulse,amd_ms,rmdv_ms",
                  "pipeline,seed,pulse,spread_ms,deviation_ms"});  // before the first release
  Row* row = nullptr;
  while (frames.next_row()) {
    score_of(frames, results, row)
        .pulses.push_back({.pulse = frames.number<std::int64_t>(2),
                           .spread_ms = frames.value(3),
                           .deviation_ms = frames.value(4)});
  }
  CsvFile hosts(archive, "hosts.csv",
                {kHostsHeader, "pipeline,seed,host,host_error_ms,synchronised",
                 "pipeline,seed,host,error_ms,synchronised"});  // before the first release
  while (hosts.next_row()) {
    SeedScore& score = score_of(hosts, results, row);
    if (hosts.number<std::size_t>(2) != score.host_errors_ms.size()) {
      hosts.fail(fmt::format("found host {}, allowed: {}, the next one", hosts.text(2),
                             score.host_errors_ms.size()));
    }
    score.host_errors_ms.push_back(hosts.value(3));
    if (const auto session = session_of(hosts)) score.sessions.push_back(*session);
  }
}

}  // namespace simbench::reports
