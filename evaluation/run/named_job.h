// A job of an evaluation, whose errors name it.
//
//   run_named({.scenario = "3cam_1host_30fps", .pipeline = "oracle", .seed = 7},
//             [&] { use(seed_score); });
#ifndef SIMBENCH_EVALUATION_RUN_NAMED_JOB_H_
#define SIMBENCH_EVALUATION_RUN_NAMED_JOB_H_

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace simbench::evaluation {

// What a job has thrown, with scenario, pipeline, seed, version and commit.
class JobFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct JobName {
  std::string scenario;
  std::string pipeline;
  std::uint64_t seed = 0;
};

// Throws scenarios::InputError for a world that its backend refuses, with the job's name;
// RecordingCancelled as it is; JobFailed for any other exception of `action`.
void run_named(const JobName& name, const std::function<void()>& action);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_RUN_NAMED_JOB_H_
