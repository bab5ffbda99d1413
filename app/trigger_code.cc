#include "app/trigger_code.h"

#include <cstddef>
#include <string>
#include <vector>

#include "evaluation/run/pipeline_choice.h"
#include "scenarios/camera_groups.h"
#include "scenarios/camera_profile.h"
#include "scenarios/loader.h"
#include "scenarios/trigger_code.h"

namespace simbench::app {
namespace {

using reports::CodeMode;
using scenarios::Scenario;

// As the first pipeline that reads the code has them.
CodeDecoderSettings decoder_settings(const Scenario& scenario) {
  for (const evaluation::PipelineChoice& choice : evaluation::choose_pipelines(scenario, {})) {
    if (choice.gathering.info().family != "coded_trigger") continue;
    return settings_from<CodeDecoderSettings>(choice.gathering.parameters);
  }
  return {};
}

// The streams of one kind of cameras, in each mode in which they follow the pulses.
void add_modes(const Scenario& alone, const TriggerCode& code, std::int64_t pulses_per_camera,
               std::vector<CodeMode>& modes) {
  const scenarios::CameraProfile& camera = *scenarios::find_camera_profile(alone.cameras.model);
  for (const scenarios::SyncModeProfile& profile : camera.sync_modes) {
    Scenario changed = alone;
    changed.cameras.sync_mode = profile.mode;
    for (const scenarios::Stream& stream : changed.cameras.streams) {
      if (!changed.cameras.follows_trigger(stream)) continue;
      CodeMode mode{.camera = camera.name,
                    .mode = std::string(to_text(profile.mode)),
                    .stream = std::string(to_text(stream.kind)),
                    .mode_rate_hz = stream.mode_rate_hz,
                    .is_own = profile.mode == alone.cameras.sync_mode,
                    .limits = code_limits(changed, stream, pulses_per_camera)};
      mode.frames_per_s = 1e9 / to_ns(code.period()) * code.sent_share() /
                          static_cast<double>(mode.limits.pulses_per_frame);
      if (const auto problem = code_problem(changed, stream, code, pulses_per_camera)) {
        mode.problem = problem->text;
      }
      modes.push_back(std::move(mode));
    }
  }
}

}  // namespace

reports::TriggerCodeResult trigger_code_of(const Scenario& scenario) {
  const auto pulses = evaluation::coded_pulses(scenario);
  if (!pulses) {
    throw scenarios::InputError(
        scenario.name +
        ": found no /trigger/code, allowed a scenario with one, as 18cam_6host_90fps_coded, or "
        "--set '/trigger/code={\"kind\": \"position\", \"order\": 12, \"shift_us\": 50}'");
  }
  const CodeDecoderSettings settings = decoder_settings(scenario);
  reports::TriggerCodeResult result{.scenario = scenario.name,
                                    .derivation = scenario.derivation,
                                    .model = *scenario.trigger.code,
                                    .code = pulses->code,
                                    .settings = settings,
                                    .forecast = forecast_of(pulses, settings),
                                    .modes = {}};
  const scenarios::Cameras& cameras = scenario.cameras;
  if (cameras.groups.empty()) add_modes(scenario, pulses->code, 1, result.modes);
  for (std::size_t group = 0; group < cameras.groups.size(); ++group) {
    add_modes(scenarios::group_alone(scenario, group), pulses->code,
              scenarios::pulses_per_frame(cameras, group), result.modes);
  }
  return result;
}

}  // namespace simbench::app
