#include "algorithms/device_time/estimator_bank.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/algorithms/device_time/polls.h"
#include "tests/algorithms/device_time/registered.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

constexpr std::size_t kBankCameras = 3;

// Noisy frames of random cameras, in order of delivery.
struct Frames {
  explicit Frames(std::uint32_t seed) {
    boost::random::mt19937 random(seed);
    for (std::int64_t i = 0; i < 900; ++i) {
      cameras.push_back(static_cast<std::uint32_t>(random() % kBankCameras));
      const std::int64_t late_ns = random() % 5'000'000;
      samples.push_back(
          sample_at(kDeviceZeroUs + 11'111 * i, kHostZeroNs + 11'111'000 * i + late_ns));
    }
  }

  std::vector<DeviceSample> of(std::size_t camera) const {
    std::vector<DeviceSample> all;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (cameras[i] == camera) all.push_back(samples[i]);
    }
    return all;
  }

  std::vector<std::uint32_t> cameras;
  std::vector<DeviceSample> samples;
};

class EveryBank : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Registered, EveryBank, ::testing::ValuesIn(registered_estimators()),
                         [](const auto& test) { return test.param; });

TEST_P(EveryBank, StampsBlocksAsItsEstimatorsDoAlone) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Frames frames(seed);
    const EstimatorFactory make = [](std::size_t) { return make_registered(GetParam()); };
    const auto bank = make_bank(make, kBankCameras);
    std::vector<std::unique_ptr<DeviceTimeEstimator>> alone;
    for (std::size_t camera = 0; camera < kBankCameras; ++camera) {
      alone.push_back(make(camera));
      if (!bank->at(camera).offline()) continue;
      bank->at(camera).learn(frames.of(camera));
      alone.back()->learn(frames.of(camera));
    }
    boost::random::mt19937 random(seed);
    std::vector<GlobalTime> stamps(frames.cameras.size());
    for (std::size_t begin = 0; begin < stamps.size();) {
      const PollSample poll =
          poll_at(static_cast<std::int64_t>(begin) * 11'111'000, 200'000, 300'000);
      for (std::size_t camera = 0; camera < kBankCameras; ++camera) {
        bank->at(camera).on_poll(poll);
        alone[camera]->on_poll(poll);
      }
      const std::size_t size = std::min<std::size_t>(random() % 40, stamps.size() - begin);
      bank->stamp(std::span(frames.cameras).subspan(begin, size),
                  std::span(frames.samples).subspan(begin, size),
                  std::span(stamps).subspan(begin, size));
      for (std::size_t i = begin; i < begin + size; ++i) {
        ASSERT_EQ(stamps[i], alone[frames.cameras[i]]->stamp(frames.samples[i]))
            << "frame " << i << ", seed " << seed;
      }
      begin += size;
    }
  }
}

TEST(EstimatorBank, IsMadeOfAnyEstimator) {
  class Numbered final : public DeviceTimeEstimator {
   public:
    explicit Numbered(std::int64_t number) : number_(number) {}
    GlobalTime stamp(const DeviceSample&) override { return GlobalTime(Nanoseconds(number_)); }

   private:
    std::int64_t number_;
  };
  std::int64_t made = 0;
  const auto bank = make_bank([&](std::size_t) { return std::make_unique<Numbered>(made++); }, 4);
  EXPECT_EQ(made, 4);
  const std::vector<std::uint32_t> cameras = {3, 0, 3};
  std::vector<GlobalTime> stamps(3);
  bank->stamp(cameras, std::vector<DeviceSample>(3), stamps);
  EXPECT_EQ(nanoseconds_of(stamps[0]), 3);
  EXPECT_EQ(nanoseconds_of(stamps[1]), 0);
  EXPECT_EQ(nanoseconds_of(stamps[2]), 3);
}

}  // namespace
}  // namespace simbench
