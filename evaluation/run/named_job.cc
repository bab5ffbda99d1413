#include "evaluation/run/named_job.h"

#include <fmt/format.h>

#include <exception>

#include "recording/recording.h"
#include "recording/version.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

void run_named(const JobName& name, const std::function<void()>& action) {
  const auto text = [&name] {
    return fmt::format("{}, pipeline {}, seed {}", name.scenario, name.pipeline, name.seed);
  };
  try {
    action();
  } catch (const RecordingCancelled&) {
    throw;
  } catch (const scenarios::InputError& error) {
    // With the cause inside, for users who want more than its text.
    std::throw_with_nested(scenarios::InputError(fmt::format("{}: {}", text(), error.what())));
  } catch (const std::exception& error) {
    throw JobFailed(
        fmt::format("{}: {} (simbench {}, commit {})", text(), error.what(), version(), commit()));
  }
}

}  // namespace simbench::evaluation
