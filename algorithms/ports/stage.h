// The stages of a pipeline, each of which is one choice of an algorithm (docs/design.md section 1).
//
// What is the same for every stage goes over kPipelineStages, in their order. What has something
// for each has a member named after it: at_stage() finds the one of a stage.
//
//   scenarios::Pipeline pipeline = scenario.pipelines.front();
//   for (const StageInfo& stage : kPipelineStages) {
//     if (at_stage(pipeline, stage.id) == "oracle") print(stage.name);
//   }
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace simbench {

enum class PipelineStage : std::uint8_t { kHostSync, kCaptureAlignment, kDeviceTime, kGathering };

struct StageInfo {
  PipelineStage id;
  const char* name;            // also of the member that a pipeline, a row or a choice has for it
  bool may_be_absent = false;  // a pipeline need not have it
};

inline constexpr std::array<StageInfo, 4> kPipelineStages = {{
    {PipelineStage::kHostSync, "host_sync"},
    {PipelineStage::kCaptureAlignment, "capture_alignment", true},
    {PipelineStage::kDeviceTime, "device_time"},
    {PipelineStage::kGathering, "gathering"},
}};

constexpr const char* name_of(PipelineStage stage) {
  return kPipelineStages[static_cast<std::size_t>(stage)].name;
}

// The member for a stage of what has one of the same type for each, as the algorithms' names of a
// pipeline or a row.
template <class Staged>
auto& at_stage(Staged& staged, PipelineStage stage) {
  switch (stage) {
    case PipelineStage::kHostSync:
      return staged.host_sync;
    case PipelineStage::kCaptureAlignment:
      return staged.capture_alignment;
    case PipelineStage::kDeviceTime:
      return staged.device_time;
    case PipelineStage::kGathering:
      break;
  }
  return staged.gathering;
}

// Gives `to` the algorithms that `from` names.
template <class From, class To>
void copy_stages(const From& from, To& to) {
  for (const StageInfo& stage : kPipelineStages) at_stage(to, stage.id) = at_stage(from, stage.id);
}

// The stages that a table of some pipelines or rows has: those that none may lack or one has.
template <class Staged>
std::vector<StageInfo> present_stages(const std::vector<Staged>& all) {
  std::vector<StageInfo> present;
  for (const StageInfo& stage : kPipelineStages) {
    const bool is_named = std::any_of(all.begin(), all.end(), [&stage](const Staged& each) {
      return !at_stage(each, stage.id).empty();
    });
    if (!stage.may_be_absent || is_named) present.push_back(stage);
  }
  return present;
}

// How a pipeline is written: "host_sync[+capture_alignment]+device_time+gathering", with blanks
// around each + if `blank` is one; of these stages.
template <class Stages>
std::string stages_formula(const Stages& stages, const std::string& blank = "") {
  std::string text;
  for (const StageInfo& stage : stages) {
    const std::string plus = text.empty() ? "" : "+" + blank;
    text += text.empty() ? "" : blank;
    text += stage.may_be_absent ? "[" + plus + stage.name + "]" : plus + stage.name;
  }
  return text;
}

// All of them in one text: the stages that are present, joined by `between`.
template <class Staged>
std::string joined_stages(const Staged& staged, const std::string& between) {
  std::string text;
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& name = at_stage(staged, stage.id);
    if (!name.empty()) text += (text.empty() ? "" : between) + name;
  }
  return text;
}

}  // namespace simbench
