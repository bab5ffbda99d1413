// The folder of a sweep, which grows while the sweep runs and from which it goes on after being
// interrupted, killed or out of disk space.
//
//   manifest.json   what is swept: scenario, axes, pipelines, seeds, program; no clock times
//   runs.log        finished runs (reports/sweep/sweep_log.h)
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
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_FOLDER_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_FOLDER_H_

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "reports/sweep/sweep_log.h"

namespace simbench::reports {

class SweepFolder {
 public:
  // `manifest`: JSON, of which every member counts. `restart`: remove another sweep that is there.
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
