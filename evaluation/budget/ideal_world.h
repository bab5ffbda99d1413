// The stages between a trigger pulse and a frame set, and worlds in which some of them are ideal.
//
// Each stage can be replaced by its oracle, alone or together with others:
//
//   trigger             every pulse on time at every camera
//   exposure            all exposures equally long and steady
//   stamp quantisation  stamps without noise, arrivals without quantum (the camera's register keeps
//                       its microsecond)
//   device clock        camera oscillators without any error
//   USB delivery        every frame stamped as if it arrived in the middle of its exposure; polls
//   of
//                       a camera's clock answered at once
//   host clock          every host reads the master's clock
//   gathering           sets by the true pulse
//
// Streams of random numbers belong to components, so a stage that is still real draws the same
// numbers whichever others are ideal. Frames that are lost stay lost. A host synchronisation that
// looks at frames sees them as they really arrive: its use of them is part of the host clock.
// Source: docs/design.md section 6; each oracle as above is a definition.
//
//   const StageSet ideal = StageSet().with(Stage::kHostClock);
//   const Scenario world = ideal_scenario(scenario, pipeline, ideal);
//   auto source = ideal_delivery(make_simulation(world), world, ideal);
#ifndef SIMBENCH_EVALUATION_BUDGET_IDEAL_WORLD_H_
#define SIMBENCH_EVALUATION_BUDGET_IDEAL_WORLD_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

enum class Stage : std::uint8_t {
  kTrigger,
  kExposure,
  kStampQuantisation,
  kDeviceClock,
  kUsbDelivery,
  kHostClock,
  kGathering,
};

inline constexpr std::size_t kStageCount = 7;
inline constexpr std::array<std::string_view, kStageCount> kStageNames = {
    "trigger",      "exposure",   "stamp quantisation", "device clock",
    "USB delivery", "host clock", "gathering"};

// A set of stages, as the bits of a number below 2^7.
class StageSet {
 public:
  static constexpr std::size_t kSets = std::size_t{1} << kStageCount;

  constexpr StageSet() = default;
  constexpr explicit StageSet(std::size_t bits) : bits_(bits) {}
  constexpr bool has(Stage stage) const { return (bits_ & bit(stage)) != 0; }
  constexpr StageSet with(Stage stage) const { return StageSet(bits_ | bit(stage)); }

 private:
  static constexpr std::size_t bit(Stage stage) {
    return std::size_t{1} << static_cast<std::size_t>(stage);
  }
  std::size_t bits_ = 0;
};

// The scenario with `pipeline` as its only one and the stages `ideal` replaced, but for the
// delivery, which a scenario cannot express.
scenarios::Scenario ideal_scenario(const scenarios::Scenario& scenario,
                                   const scenarios::Pipeline& pipeline, StageSet ideal);

// `source` itself, or with the stamps of an ideal delivery if `ideal` has that. `world` is the
// scenario that the source simulates. record() throws std::runtime_error on a frame without truth.
std::unique_ptr<RecordingSource> ideal_delivery(std::unique_ptr<RecordingSource> source,
                                                const scenarios::Scenario& world, StageSet ideal);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_BUDGET_IDEAL_WORLD_H_
