// The choices of a scenario: an enum for each member whose values are words, and its words.
//
// Each word stands once, in the table below its enum, for the loader, descriptions and messages; a
// test compares the tables with the "enum" lists of scenarios/schema.json. Names of algorithms,
// pipelines and camera models are open-ended and stay text.
//
//   to_text(SyncMode::kFullSlave)         // "full_slave"
//   from_text<SyncMode>("full_slave")     // SyncMode::kFullSlave
//   from_text<SyncMode>("fullslave")      // nothing
//   all_texts<SyncMode>()                 // "default", "master", "slave", "full_slave", "genlock"
//
// The meaning of each value is documented at its member (scenarios/scenario.h).
#ifndef SIMBENCH_SCENARIOS_CHOICES_H_
#define SIMBENCH_SCENARIOS_CHOICES_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace simbench::scenarios {

template <class Enum>
struct Word {
  Enum value;
  std::string_view text;
};

enum class StreamKind : std::uint8_t { kDepth, kColour };
constexpr auto words_of(StreamKind) {
  using enum StreamKind;
  return std::to_array<Word<StreamKind>>({{kDepth, "depth"}, {kColour, "colour"}});
}

// Where receive stamps are taken.
enum class StampPoint : std::uint8_t { kApplication, kKernel };
constexpr auto words_of(StampPoint) {
  using enum StampPoint;
  return std::to_array<Word<StampPoint>>({{kApplication, "application"}, {kKernel, "kernel"}});
}

// The PTP support of the switch.
enum class SwitchClockKind : std::uint8_t { kNone, kTransparent, kBoundary };
constexpr auto words_of(SwitchClockKind) {
  using enum SwitchClockKind;
  return std::to_array<Word<SwitchClockKind>>(
      {{kNone, "none"}, {kTransparent, "transparent"}, {kBoundary, "boundary"}});
}

enum class ShutterKind : std::uint8_t { kGlobal, kRolling };
constexpr auto words_of(ShutterKind) {
  using enum ShutterKind;
  return std::to_array<Word<ShutterKind>>({{kGlobal, "global"}, {kRolling, "rolling"}});
}

// Inter Cam Sync Mode: how the camera responds to a pulse.
enum class SyncMode : std::uint8_t { kDefault, kMaster, kSlave, kFullSlave, kGenlock };
constexpr auto words_of(SyncMode) {
  using enum SyncMode;
  return std::to_array<Word<SyncMode>>({{kDefault, "default"},
                                        {kMaster, "master"},
                                        {kSlave, "slave"},
                                        {kFullSlave, "full_slave"},
                                        {kGenlock, "genlock"}});
}
// Whether cameras in this mode wait for the pulses of the rig's trigger. Which of their streams
// follow the pulses depends on the model: Cameras::follows_trigger().
constexpr bool waits_for_trigger(SyncMode mode) {
  return mode != SyncMode::kDefault && mode != SyncMode::kMaster;
}

// Whose oscillator or clock something of a camera is of.
enum class ClockOwner : std::uint8_t { kCamera, kHost };
constexpr auto words_of(ClockOwner) {
  using enum ClockOwner;
  return std::to_array<Word<ClockOwner>>({{kCamera, "camera"}, {kHost, "host"}});
}

// How the cameras of a USB controller share its bandwidth.
enum class UsbSharing : std::uint8_t { kDedicated, kFair, kFifo };
constexpr auto words_of(UsbSharing) {
  using enum UsbSharing;
  return std::to_array<Word<UsbSharing>>(
      {{kDedicated, "dedicated"}, {kFair, "fair"}, {kFifo, "fifo"}});
}

// The order of the rows: as listed, sorted by absolute error, or by how far exposures are apart.
enum class TableKind : std::uint8_t { kPipelines, kLeaderboard, kAlignment };
constexpr auto words_of(TableKind) {
  using enum TableKind;
  return std::to_array<Word<TableKind>>(
      {{kPipelines, "pipelines"}, {kLeaderboard, "leaderboard"}, {kAlignment, "alignment"}});
}

// The median of an even number of values, which the paper does not define.
enum class MedianKind : std::uint8_t {
  kUpperMiddle,      // sorted[n / 2]
  kMeanOfMiddleTwo,  // (sorted[n / 2 - 1] + sorted[n / 2]) / 2
};
constexpr auto words_of(MedianKind) {
  using enum MedianKind;
  return std::to_array<Word<MedianKind>>(
      {{kUpperMiddle, "upper_middle"}, {kMeanOfMiddleTwo, "mean_of_middle_two"}});
}

enum class SubjectKind : std::uint8_t { kPerson, kMesh };
constexpr auto words_of(SubjectKind) {
  using enum SubjectKind;
  return std::to_array<Word<SubjectKind>>({{kPerson, "person"}, {kMesh, "mesh"}});
}

// The motion of a studio's subject.
enum class MotionScript : std::uint8_t { kStand, kTurn, kWalk, kWalkAndTurn, kRaiseArms };
constexpr auto words_of(MotionScript) {
  using enum MotionScript;
  return std::to_array<Word<MotionScript>>({{kStand, "stand"},
                                            {kTurn, "turn"},
                                            {kWalk, "walk"},
                                            {kWalkAndTurn, "walk_and_turn"},
                                            {kRaiseArms, "raise_arms"}});
}
constexpr bool walks(MotionScript motion) {
  return motion == MotionScript::kWalk || motion == MotionScript::kWalkAndTurn;
}
constexpr bool turns(MotionScript motion) {
  return motion == MotionScript::kTurn || motion == MotionScript::kWalkAndTurn;
}

// An enum with a table of words.
template <class Enum>
concept Choice = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value);
};

template <Choice Enum>
constexpr std::string_view to_text(Enum value) {
  for (const Word<Enum>& word : words_of(value)) {
    if (word.value == value) return word.text;
  }
  return "?";  // no value of the enum
}

// Nothing if `text` is no word of the enum.
template <Choice Enum>
constexpr std::optional<Enum> from_text(std::string_view text) {
  for (const Word<Enum>& word : words_of(Enum{})) {
    if (word.text == text) return word.value;
  }
  return std::nullopt;
}

// In the order of the schema.
template <Choice Enum>
std::vector<std::string> all_texts() {
  std::vector<std::string> texts;
  for (const Word<Enum>& word : words_of(Enum{})) texts.emplace_back(word.text);
  return texts;
}

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_CHOICES_H_
