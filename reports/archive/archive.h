// The result archive that --output writes, with all that is needed to read, check and repeat a run.
//
//   manifest.json   the fully resolved scenario, its changes (reports/results/json.h),
//                   seeds, version, commit, command, start and end
//   results.json    see reports/results/json.h
//   frames.csv      spread and deviation of every evaluated pulse
//   hosts.csv       mean clock error of every host, and the delays of its session if it had one
//
// Only manifest.json (its clock times) and /performance in results.json differ between equal runs.
//
// The reader checks everything: it refuses a file that was cut short, edited by hand or written
// with a newer schema, with file, line and JSON pointer, what was found and what is allowed. It
// computes medians and bands again from the values, so that an archive cannot contradict itself.
//
// Errors: scenarios::InputError in reading, OutputError in writing.
//
//   const Archive monday = read_archive("results/monday");
//   for (const evaluation::Row& row : monday.results.rows) use(row.amd_ms.values);
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "evaluation/clock_run/clock_score.h"
#include "evaluation/scoring/results.h"
#include "recording/version.h"
#include "reports/results/results_answer.h"
#include "reports/text/json_node.h"
#include "reports/text/output_file.h"
#include "scenarios/scenario.h"

namespace simbench::reports {

// The command and the times of a result.
struct Provenance {
  std::vector<std::string> command;  // argv
  std::chrono::system_clock::time_point started;
  std::chrono::system_clock::time_point finished;
};

// Returns a command as a POSIX shell takes it.
std::string shell_line(const std::vector<std::string>& words);
// Does so for an argv of simbench, without the path of the program.
std::string simbench_line(std::vector<std::string> command);

// Returns a manifest: schema_version, program, version, commit, command, started, finished (ISO
// 8601, UTC), and the members of `more`.
std::string manifest_json(const Provenance& provenance, const Json& more);
// That of results: of what runs, seeds, pipelines and scenario.
std::string manifest_json(const Provenance& provenance, const evaluation::Results& results,
                          const scenarios::Scenario& scenario);

// Writes and publishes. After an OutputError nothing is left. `answer`: of the results; null: it is
// computed, without levers.
void write_archive(OutputFolder& output, const evaluation::Results& results,
                   const scenarios::Scenario& scenario, const Provenance& provenance,
                   const ResultsAnswer* answer = nullptr);

// Writes the files of an archive under names that begin with `prefix` ("45fps/": a folder in the
// folder), for a folder of more than one; publishes nothing.
void write_archive_files(OutputFolder& output, const std::string& prefix,
                         const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const Provenance& provenance, const ResultsAnswer* answer = nullptr);

// What the results of a file are of: the member, which only files of clock runs have.
inline constexpr const char* kClockRunsName = "clocks";
evaluation::ResultKind read_result_kind(const JsonNode& root, const char* member);
// The members from_s and duration_s; only such files have them.
evaluation::ClockPeriod read_clock_period(const JsonNode& root, evaluation::ResultKind kind);

// The member of a scenario that files of other people were scored by (app/stream_run.h).
inline constexpr const char* kRecordingMember = "recording";

struct Archive {
  std::string path;                                        // as the user stated it
  std::string version = std::string(simbench::version());  // of the program that made it
  std::string commit = std::string(simbench::commit());
  std::vector<std::string> command{};  // from here to scenario_json: only with a manifest
  std::string started{};
  std::string finished{};
  std::string scenario_json{};  // resolved; load it with scenarios::load_scenario_text
  std::vector<evaluation::StabilityCurves> curves{};  // of clock runs, by row
  // As evaluate() returned them, without Row::seeds: the values of the row's series have the scores
  // of the seeds, in seed order.
  evaluation::Results results;
};

// Whether it is of files of other people, so that no run can be repeated.
bool is_of_files(const Archive& archive);

// `path`: an archive's folder, or a results.json alone, without a manifest.
Archive read_archive(const std::string& path);

// The archive that write_archive() makes of these at `path`, with the seed details of the results.
Archive kept_archive(const std::string& path, const evaluation::Results& results,
                     const scenarios::Scenario& scenario, const Provenance& provenance);

// Sets Row::seeds from frames.csv and hosts.csv: seed, pulses, host_errors_ms, of sessions the
// slave, its last pass and its delays, and nothing else. The archive must be a folder.
void read_seed_details(Archive& archive);

}  // namespace simbench::reports
