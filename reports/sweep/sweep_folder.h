// The folder of a sweep, which grows while the sweep runs, so that an interrupted sweep can
// continue.
//
//   manifest.json   the sweep: scenario, axes, pipelines, seeds, program; no clock times
//   runs.log        finished runs
//   and, once all runs are finished, the results: sweep.csv, hosts.csv, sweep.txt, sweep.html,
//   sweep.svg, answer.json: the answer for programs (reports/text/answer_json.h), with "scenario"
//   and "ranked_by", the metric
//
// The manifest identifies the sweep: a folder of another sweep, or with any other file, is refused.
// The folder is locked during the lifetime of a SweepFolder; the lock file `lock` stays.
//
// The log has one line for each finished run, "RUN CHECKSUM TEXT", and only grows, so that no end
// of the program loses a line. RUN is the run's number in its plan, CHECKSUM the CRC-32 of the
// sweep's identity, RUN and TEXT. A line that is cut short, changed, or of another sweep is
// damaged: its run does not count as finished.
//
//   SweepFolder folder("results/rate", manifest, plan.runs(), /*restart=*/false);
//   if (folder.log().text(7).empty()) folder.log().append(7, work_on(7));
//   folder.write("sweep.csv", text);
//
// Not thread-safe. Errors: OutputError, whose message states the remedy; the appended runs stay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

class SweepLog {
 public:
  // Reads an existing file; removes damaged lines from it.
  SweepLog(std::filesystem::path path, std::string_view identity, std::size_t runs);
  ~SweepLog();
  SweepLog(const SweepLog&) = delete;
  SweepLog& operator=(const SweepLog&) = delete;

  // The text of a finished run; empty: it is not finished.
  const std::string& text(std::size_t run) const { return texts_[run]; }
  std::size_t finished() const { return finished_; }
  // Lines that did not count when the file was read.
  std::size_t damaged() const { return damaged_; }

  // `text`: one line, not empty. A single write, so that a killed program leaves whole lines.
  void append(std::size_t run, const std::string& text);
  // Rewrites the file in the order of the runs: two finished sweeps have the same bytes.
  void put_in_order();

 private:
  std::string line(std::size_t run, std::string_view text) const;
  std::uint32_t checksum(std::string_view run, std::string_view text) const;
  bool take(std::string_view line);
  void read();
  void open_at_end();
  void close();

  std::filesystem::path path_;
  std::uint32_t identity_ = 0;
  std::vector<std::string> texts_;
  std::size_t finished_ = 0;
  std::size_t damaged_ = 0;
  int file_ = -1;
  std::int64_t size_ = 0;
};

class SweepFolder {
 public:
  // `manifest`: JSON, of which every member counts. `restart`: removes another sweep in the folder.
  SweepFolder(const std::filesystem::path& folder, const std::string& manifest, std::size_t runs,
              bool restart);
  ~SweepFolder();
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  SweepLog& log() { return *log_; }
  // Writes or replaces a file, completely or not at all.
  void write(const std::string& name, std::string_view content);
  // Removes a result of this sweep, if it exists.
  void remove(const std::string& name);
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 private:
  void check_contents() const;
  void lock();
  void check_manifest(const std::string& manifest) const;
  void check_is_sweep(const std::string& manifest) const;
  void remove_all() const;

  std::filesystem::path folder_;
  int lock_ = -1;
  std::unique_ptr<SweepLog> log_;
};

}  // namespace simbench::reports
