// From a simulated rig with a known fault to bags, and back to the fault.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/recorded_streams.h"
#include "evaluation/diagnosis/diagnose.h"
#include "recording/temporary_folder.h"
#include "tests/app/rig_bags.h"

namespace simbench {
namespace {

using Rig = std::vector<RecordedStream>;
using std::chrono::milliseconds;

constexpr int kFrames = 6000;  // 200 s
constexpr Nanoseconds kPeriod = Nanoseconds(33'333'333);
constexpr std::int64_t kRegisterNs = (std::int64_t{1} << 32) * 1000;

bool are_equal(const RecordedStream& a, const RecordedStream& b) {
  return std::ranges::equal(a.frames, b.frames, [](const StampedFrame& x, const StampedFrame& y) {
    return x.counter == y.counter && x.sensor == y.sensor && x.arrival == y.arrival;
  });
}

// The bags of a rig; writing them is what takes the time, so a rig that differs in few cameras
// shares the others'.
class RigBags {
 public:
  explicit RigBags(Rig rig) : rig_(std::move(rig)) {
    for (const RecordedStream& camera : rig_)
      files_.push_back(write_sdk_bag(camera, folder_.path()));
  }

  // The rig must have the same cameras.
  evaluation::Diagnosis diagnosed(const Rig& rig) const {
    const TemporaryFolder changed;
    std::vector<std::string> files = files_;
    for (std::size_t i = 0; i < rig.size(); ++i) {
      if (!are_equal(rig[i], rig_[i])) files[i] = write_sdk_bag(rig[i], changed.path());
    }
    const RecordedStreams read = app::recorded_streams(files);
    return evaluation::diagnose(read.streams, {.one_host = true});
  }

  const Rig& rig() const { return rig_; }

 private:
  const TemporaryFolder folder_;
  const Rig rig_;
  std::vector<std::string> files_;
};

// "kind camera" of each finding; the register's wrap is no fault.
std::set<std::string> faults(const evaluation::Diagnosis& diagnosis) {
  std::set<std::string> found;
  for (const evaluation::Finding& finding : diagnosis.findings) {
    if (finding.kind != "register_wraps") found.insert(finding.kind + " " + finding.camera);
  }
  return found;
}

void set_sensor(StampedFrame& frame, Nanoseconds sensor) {
  frame.sensor = Nanoseconds((sensor.count() % kRegisterNs + kRegisterNs) % kRegisterNs);
}

std::vector<StampedFrame>& frames(Rig& rig, std::size_t camera) {
  const std::string name = "camera" + std::to_string(camera);
  return std::ranges::find(rig, name, &RecordedStream::camera)->frames;
}

void lose_frames(Rig& rig) {
  std::mt19937 random(3);
  std::erase_if(frames(rig, 2), [&](const StampedFrame&) { return random() % 100 == 0; });
}

void run_free(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  const Nanoseconds first = all.front().arrival;
  for (StampedFrame& frame : all) {
    frame.arrival += Nanoseconds((frame.arrival - first).count() * 30 / 1'000'000);
  }
}

void halve_rate(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  std::vector<StampedFrame> half;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    half.push_back(all[i]);
    half.back().counter = half.size();
  }
  all = half;
}

void slip(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  for (std::size_t i = all.size() / 2; i < all.size(); ++i) {
    set_sensor(all[i], all[i].sensor - kPeriod);
  }
}

void swap_topics(Rig& rig) {
  std::vector<StampedFrame>& a = frames(rig, 1);
  std::vector<StampedFrame>& b = frames(rig, 4);
  for (std::size_t i = kFrames / 2; i < std::min(a.size(), b.size()); ++i) std::swap(a[i], b[i]);
}

void step_clock(Rig& rig) {
  for (RecordedStream& camera : rig) {
    for (std::size_t i = kFrames / 2; i < camera.frames.size(); ++i) {
      camera.frames[i].arrival += milliseconds(250);
    }
  }
}

void wrap(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  const Nanoseconds middle = all[all.size() / 2].sensor;
  for (StampedFrame& frame : all) set_sensor(frame, frame.sensor - middle);
}

void hold_up(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  for (std::size_t i = 1000; i < 1040; ++i) all[i].arrival += milliseconds(20 + 7 * (i % 3));
}

void start_late(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  all.erase(all.begin(), all.begin() + 150);
}

void repeat_stamps(Rig& rig) {
  std::vector<StampedFrame>& all = frames(rig, 2);
  for (const std::size_t i : {500U, 900U, 901U, 1500U}) all[i].sensor = all[i - 1].sensor;
}

TEST(BagDiagnosisTest, CleanRigsHaveNoFault) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RigBags bags(simulated_rig(seed, 6, kFrames));
    const evaluation::Diagnosis diagnosis = bags.diagnosed(bags.rig());
    EXPECT_THAT(faults(diagnosis), testing::IsEmpty()) << "seed " << seed;
    EXPECT_EQ(diagnosis.verdict.status, evaluation::SyncStatus::kWorks)
        << "seed " << seed << ": " << diagnosis.verdict.reason;
  }
}

struct Fault {
  const char* name;
  std::function<void(Rig&)> inject;
  std::set<std::string> found;    // at least
  std::set<std::string> cameras;  // that may be named at all; empty: all
};

TEST(BagDiagnosisTest, EachOfTenFaultsIsFoundWhereItIs) {
  const std::vector<Fault> kinds = {
      {"lost frames", lose_frames, {"lost_frames camera2"}, {"camera2"}},
      {"free-running", run_free, {"free_running camera2"}, {"camera2"}},
      {"half the rate", halve_rate, {"divided_rate camera2"}, {"camera2"}},
      {"slipped period", slip, {"period_slip camera2"}, {"camera2"}},
      {"swapped topics",
       swap_topics,
       {"swapped camera1", "swapped camera4"},
       {"camera1", "camera4"}},
      {"clock step", step_clock, {"clock_step camera0", "clock_step camera5"}, {}},
      {"wrap", wrap, {}, {"none"}},
      {"jitter burst", hold_up, {"late_burst camera2"}, {"camera2"}},
      {"late start", start_late, {"late_start camera2"}, {"camera2"}},
      {"duplicated stamps", repeat_stamps, {"repeated_stamps camera2"}, {"camera2"}},
  };
  for (std::uint64_t seed = 31; seed <= 32; ++seed) {
    const RigBags bags(simulated_rig(seed, 6, kFrames));
    for (const Fault& fault : kinds) {
      Rig rig = bags.rig();
      fault.inject(rig);
      const evaluation::Diagnosis diagnosis = bags.diagnosed(rig);
      const std::set<std::string> found = faults(diagnosis);
      for (const std::string& expected : fault.found) {
        EXPECT_THAT(found, testing::Contains(expected)) << fault.name << ", seed " << seed;
      }
      for (const evaluation::Finding& finding : diagnosis.findings) {
        if (fault.cameras.empty() || finding.kind == "register_wraps") continue;
        EXPECT_TRUE(fault.cameras.contains(finding.camera))
            << fault.name << ", seed " << seed << ": " << finding.text;
      }
      if (std::string(fault.name) == "wrap") {
        EXPECT_TRUE(std::ranges::any_of(diagnosis.findings, [](const evaluation::Finding& f) {
          return f.kind == "register_wraps" && f.camera == "camera2";
        }));
      }
    }
  }
}

}  // namespace
}  // namespace simbench
