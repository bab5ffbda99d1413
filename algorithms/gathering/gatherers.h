// The gathering policies; gathering.h has their interface.
//
// Each has a queue per source, of GatheringSetup::queue_limit frames if that is stated. Else it is
// as long as that of the program (docs/reference/gathering.md section 5): unbounded in the paper's
// policies and the oracle, else the constants below.
//
//   auto gatherer = make_yoon2021_gatherer({.sources = 18, .period = from_ms(22)});
//   gatherer->push(frame, set_sink);
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/certificates/online_certificates.h"
#include "algorithms/coded_trigger/code_search.h"
#include "algorithms/gathering/gathering.h"
#include "algorithms/gathering/genlock_order.h"

namespace simbench {

inline constexpr std::uint32_t kRosQueue = 10;            // per topic, of its tests
inline constexpr std::uint32_t kK4aQueue = 16;            // 15, and the frame that is compared
inline constexpr std::uint32_t kLibrealsenseQueue = 10;   // QUEUE_MAX_SIZE
inline constexpr std::uint32_t kPhaseBinningSlots = 64;   // an assumption: no program is meant
inline constexpr std::uint32_t kCodedTriggerQueue = 256;  // as many as a camera may hold back

// Gathering by Algorithm 3 of the paper, as a streaming class.
//
// A queue of global stamps per source. While no queue is empty: if the fronts' range is less than
// T_int (GatheringSetup::interval, which must be positive), they are a set and all are popped; else
// the earliest front is discarded, of equal ones that of the lowest source.
//
// What to expect: no set has a range of T_int or more; a missing frame never blocks, but its whole
// instant is lost, as there are no partial sets; a set waits for the slowest source. A constant
// offset of T_int or more between two sources gives no set at all, and one of about a period gives
// wrong sets silently: T_int should be half a period or less, and stamps better than that.
//
// Complexity and memory: gathering/fronts.h. Source: docs/reference/paper.md section 5.
std::unique_ptr<Gatherer> make_yoon2021_gatherer(const GatheringSetup& setup);

// Gathering by GenLock order: a set is the frames of one trigger pulse, known by counting.
//
// The ground truth of the paper. Each source's frames get the index of their pulse from their
// sensor stamps (gathering/genlock_order.h); a set is emitted as soon as every source has delivered
// its frame of one index, and older, incomplete indices are discarded. Global stamps are ignored.
// Needs a capture whose cameras all start with one pulse.
//
// GatheringSetup::period is the nominal frame period. Complexity and memory:
// gathering/fronts.h. Source: docs/reference/paper.md sections 5 and 8.
std::unique_ptr<Gatherer> make_genlock_gatherer(const GatheringSetup& setup,
                                                GenlockOrder::Variant variant);

// Gathering by the ApproximateTime policy of ROS: the narrowest sets, whatever their width.
//
// A candidate is the fronts of all queues, from its earliest to its latest stamp. The source with
// the latest front of the first candidate is the pivot: every set found in this search has that
// frame. The earliest front steps aside again and again; the fronts replace the candidate if they
// are narrower by more than the penalty for being later,
//   (end - candidate end) * (1 + age_penalty) < start - candidate start,
// and the candidate is emitted once no later one can do that: when the pivot itself would step
// aside, or (end - candidate end) * (1 + age_penalty) >= pivot - candidate start. For an empty
// queue the search continues with the earliest stamp that its next frame can have, which is that of
// its last frame plus `lower_bound`, or the pivot's if that is later; if this decides nothing, it
// is undone until a frame comes. A full queue drops its oldest frame and with it the candidate;
// until a candidate without that source as pivot has passed, the source is no pivot.
//
// What to expect: each frame is used at most once, sets do not cross, and only stamps matter, not
// the order of arrival. Without a lower bound a set waits about one period for the proof that it is
// the best; without a largest interval, a lost frame gives a set with a frame of another exposure.
// Stamps of a source should increase; if they do not, its frames still leave in order of arrival,
// and no search is endless.
//
// Complexity: O(log n) per frame that steps aside, O(n) per set; steps that decided nothing are
// repeated only after a frame that may change that. Memory: n * (queue + 1) frames.
// Source: ros_comm message_filters sync_policies/approximate_time.h; docs/reference/gathering.md.
//
//   auto gatherer = make_approximate_time_gatherer(setup, {.lower_bound = setup.period / 2});
struct ApproximateTimeOptions {
  double age_penalty = 0.1;         // not negative
  Nanoseconds lower_bound{};        // between two frames of a source; 0: none is known
  Nanoseconds max_interval{};       // of a set, itself allowed; 0: any
  std::uint32_t queue = kRosQueue;  // frames per source, if setup.queue_limit is empty
  // By source, in place of lower_bound; empty: lower_bound holds for all.
  std::vector<Nanoseconds> lower_bounds{};
};

std::unique_ptr<Gatherer> make_approximate_time_gatherer(const GatheringSetup& setup,
                                                         const ApproximateTimeOptions& options);

// Gathering by the ApproximateEpsilonTime policy of ROS 2: sets no wider than epsilon.
//
// While every source has a front: if all fronts are within epsilon (GatheringSetup::interval,
// itself allowed) of the earliest, they are a set; else every front within epsilon of the earliest
// is discarded.
//
// What to expect: as Algorithm 3, but where that discards one frame, this discards all within
// epsilon of it, which sometimes costs a good set when stamps are noisy. Sets do not cross, each
// frame is used at most once, there are no partial sets. A full queue drops its oldest frame.
//
// Complexity: O(log n) per discarded frame, O(n) per set. Memory: a full queue per source.
// Source: ros2/message_filters sync_policies/approximate_epsilon_time; docs/reference/gathering.md.
std::unique_ptr<Gatherer> make_epsilon_gatherer(const GatheringSetup& setup);

// Gathering like the default matcher of librealsense's syncer, here for any number of sources.
//
// Two stamps are equivalent if they are less than half a gap apart; the gap is the frame period.
// When a frame arrives, the earliest front and all fronts equivalent to it are a group. If there is
// a later front, the group is emitted at once. Else it waits for every source without a front that
// may still belong to it: one whose next frame - expected a gap after its last - is equivalent to
// the group's earliest, or overdue against the newest arrival by less than seven gaps. A source
// overdue by more, or without a frame so far, is inactive: no group waits for it until it delivers
// again. Groups of all sources are sets, smaller ones are partial sets
// (FrameSetSink::on_partial_set), singles included.
//
// What to expect: frames never wait long and only a full queue discards any; partial sets are
// common where frames are lost. The first frames come out alone, as no source is active before its
// first. Between hosts it pairs neighbouring exposures as soon as the stamps are half a period
// apart. Sets do not cross and are less than half a gap wide.
//
// Unlike the original, which makes one such matcher per device and never pairs two devices, has
// each stream's own rate where this one has one period for all, and compares fronts in the order of
// addresses in memory, which only matters from three sources on and here is by time.
//
// Complexity: O(1) per frame that waits, O(n) per set, partial or not. Memory: a full queue each.
// Uses GatheringSetup::period, not interval.
// Source: librealsense src/sync.cpp (timestamp_composite_matcher); docs/reference/d455.md
// section 6.
std::unique_ptr<Gatherer> make_librealsense_gatherer(const GatheringSetup& setup);

// Gathering like the Azure Kinect's pairing of colour and depth, here for any number of sources.
//
// Source 0 is the reference. Its front at t opens a window for every other source,
//   [t - P/4 + delay, t + 3P/4 + delay],
// ends included. If a front is later than the window's end, the reference's front is discarded; if
// it is earlier than its begin, that front is discarded; if all are in their windows, they are a
// set. `delay` is how much later than the reference the others are exposed on purpose. A full queue
// drops its oldest frame.
//
// What to expect: a pair forms as soon as both are there. The window is a whole period long but
// leans to the late side: frames that should be equal pair with their neighbours as soon as one is
// P/4 early, so the stamps' noise must stay below that. Sets do not cross; no partial sets.
//
// The original cuts its first windows at 0, as its stamps start near 0 and are unsigned; not here.
//
// Complexity: O(1) amortised per frame, O(n) per frame of the reference. Memory: a full queue each.
// Uses GatheringSetup::period, not interval.
// Source: Azure-Kinect-Sensor-SDK src/capturesync/capturesync.c; docs/reference/gathering.md.
std::unique_ptr<Gatherer> make_k4a_gatherer(const GatheringSetup& setup,
                                            Nanoseconds delay = Nanoseconds::zero());

// Gathering by the phase of a common frame period: each frame belongs to the nearest grid point.
//
// The stamps of all sources together define a grid, phase + k * period: a frame belongs to slot
// k = round((t - phase) / period), and a slot that has a frame of every source is a set. The phase
// is the running circular mean of the stamps modulo the period, in which a frame weighs `decay`
// times its successor. The grid moves from frame to frame, so a small error of the period never
// adds up.
//
// What to expect: the best policy for noisy stamps, as up to half a period from the *mean* is
// allowed and no frame is compared with another; but it needs a rig whose sources share one stable
// phase, and sources whose constant offsets differ by half a period give mixed sets. It discards a
// second frame of a source in a slot, slots older than the last set (sets do not cross while a
// source's stamps increase), and frames for these. No partial sets. As many slots are open as the
// queue has frames; a new one takes the place of an old one. Stamps that fall back by so many
// periods or more begin anew.
//
// Complexity: O(1) per frame, O(n) per slot. Memory: n frames for each slot. Uses
// GatheringSetup::period (at least a microsecond), not interval. `decay` is in [0, 1).
// Source: practice of genlock rigs; docs/reference/gathering.md.
inline constexpr double kPhaseDecay = 0.98;
std::unique_ptr<Gatherer> make_phase_binning_gatherer(const GatheringSetup& setup,
                                                      double decay = kPhaseDecay);

// Gathering by a coded trigger: a set is the frames of one pulse, which each camera's own sensor
// stamps name (coded_trigger/code_decoder.h).
//
// Needs GatheringSetup::pulses. Global stamps, arrivals and hosts' clocks are ignored, and the
// cameras may start at any time. A source whose place in the code is not known yet holds its frames
// back; when it is found, they are gathered too. A frame whose stamp is not where the code has a
// pulse is discarded: it is in no set.
//
// A code names a pulse within one of its cycles. A source that finds its place takes the cycle that
// brings it nearest to the source that delivered last: frames of one pulse must come within half of
// the code's span of each other, which is many seconds. From then on its own clock counts.
//
// What to expect: sets do not cross, and none is mixed but with settings.error_probability a source
// and search, if the stamps' noise is what is stated. Until the last source has found its place no
// set comes, and other sources' frames wait for it, kCodedTriggerQueue of each; their oldest are
// discarded.
//
// place_search() says how long it took and how sure the places are.
//
// Complexity: O(1) per frame once a place is known, else O(length of the code); sets as
// gathering/fronts.h. Memory: 48 bytes a source and pulse of the code, and the queues.
// Source: docs/coded_trigger.md.
std::unique_ptr<Gatherer> make_coded_trigger_gatherer(const GatheringSetup& setup,
                                                      const CodeDecoderSettings& settings);

// Gathering with a guarantee: the sets of Algorithm 3 that are surely of frames within half a
// period.
//
// Each set of make_yoon2021_gatherer() is emitted if no two of its frames can have been exposed
// half of GatheringSetup::period apart or more, whatever the delays were, by what the polls and
// exchanges until then prove (algorithms/certificates/online_certificates.h); the frames of others
// are discarded.
//
// What to expect: no set mixes pulses if the rates and stamps are within what `rig` says, at the
// cost of all sets for which nobody can know; without polls, or without exchanges between hosts,
// none. Once the evidence contradicts `rig`, no set is emitted any more.
//
// Complexity: that of OnlineCertificates; a set O(n^2). Memory: 128 frames a source. Source:
// docs/certificates.md.
std::unique_ptr<Gatherer> make_certified_gatherer(const GatheringSetup& setup,
                                                  const CertifiedRig& rig);

// Gathering by the truth: a set is the frames that one trigger pulse exposed.
//
// GatherFrame::tag must be the true pulse, known in a simulation only (Need::kTruth); a frame of no
// pulse (tag below 0) is discarded. A set is emitted as soon as every source has delivered its
// frame of one pulse, and older, incomplete pulses are then discarded. No policy can gather better:
// its recall is 1 unless a limited queue overflows.
//
// Complexity and memory: gathering/fronts.h.
std::unique_ptr<Gatherer> make_oracle_gatherer(const GatheringSetup& setup);

}  // namespace simbench
