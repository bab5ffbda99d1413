// The folder of a sweep, which grows while the sweep runs and from which it goes on after being
// interrupted, killed or out of disk space.
//
//   manifest.json   what is swept: scenario, axes, pipelines, seeds, program; no clock times
//   runs.log        finished runs (reports/sweep/sweep_folder.h)
//   and, once all runs are finished, the results: sweep.csv, hosts.csv, sweep.txt, sweep.svg
//
// The manifest is the sweep's identity: a folder of another sweep, or with anything else in it, is
// refused. The folder is locked while this lives; the file `lock` for that stays.
//
//   SweepFolder folder("results/rate", manifest, plan.runs(), /*restart=*/false);
//   folder.log().append(run, text);
//   folder.write("sweep.csv", text);
//
// Errors: OutputError, whose message says what to do.
@ @
// The finished runs of a sweep: a file that only grows, one line for each run, so that whatever
// ends the program loses none that had been written.
//
//   RUN CHECKSUM TEXT
//
// RUN is the run's number in its plan and CHECKSUM the CRC-32 of the sweep's identity, RUN and
// TEXT. A line that is cut short or changed, or was written for another sweep, is damaged and does
// not count: its run is not finished.
//
//   SweepLog log("results/runs.log", identity, plan.runs());
//   if (log.text(7).empty()) log.append(7, work_on(7));
//
// Not thread-safe. Errors: OutputError; what had been appended stays.
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_FOLDER_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_FOLDER_H_

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
    // Reads what is there, if anything; damaged lines are taken out of the file.
    SweepLog(std::filesystem::path path, std::string_view identity, std::size_t runs);
    ~SweepLog();
    SweepLog(const SweepLog&) = delete;
    SweepLog& operator=(const SweepLog&) = delete;

    // Of a finished run; empty: it is not finished.
    const std::string& text(std::size_t run) const { return texts_[run]; }
    std::size_t finished() const { return finished_; }
    // Lines that did not count when the file was read.
    std::size_t damaged() const { return damaged_; }

    // `text`: one line, not empty. A single write, so that what is killed leaves whole lines.
    void append(std::size_t run, const std::string& text);
    // Writes the file anew, in the order of the runs: two sweeps that are done have the same bytes.
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

  // Writes a file whole or not at all: under a temporary name (NAME.tmp), then renamed. Throws
  // OutputError.
  void replace_file(const std::filesystem::path& path, std::string_view content);

  class SweepFolder {
   public:
    // `manifest`: JSON, of which every member counts. `restart`: remove another sweep that is
    // there.
    SweepFolder(const std::filesystem::path& folder, const std::string& manifest, std::size_t runs,
                bool restart);
    ~SweepFolder();
    SweepFolder(const SweepFolder&) = delete;
    SweepFolder& operator=(const SweepFolder&) = delete;

    SweepLog& log() { return *log_; }
    // A file appears whole or not at all; an earlier one is replaced.
    void write(const std::string& name, std::string_view content);
    // Removes a result of this sweep, if it is there.
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

#endif  // SIMBENCH_REPORTS_SWEEP_SWEEP_FOLDER_H_
