#include "scenarios/d455_profiles.h"

#include <fmt/format.h>

namespace simbench::scenarios {
namespace {

struct Profile {
  std::string_view kind;
  std::int64_t width;
  std::int64_t height;
  std::vector<double> rates_hz;
};

const std::vector<Profile>& profiles() {
  static const std::vector<Profile> all = {
      {"depth", 1280, 720, {15, 30}},
      {"depth", 848, 480, {15, 30, 60, 90}},
      {"depth", 848, 100, {100}},
      {"depth", 640, 480, {15, 30, 60, 90}},
      {"depth", 640, 360, {15, 30, 60, 90}},
      {"depth", 480, 270, {15, 30, 60, 90}},
      {"depth", 424, 240, {15, 30, 60, 90}},
      {"depth", 256, 144, {90}},
      {"colour", 1280, 800, {10, 15, 30}},
      {"colour", 1280, 720, {10, 15, 30}},
      {"colour", 848, 480, {15, 30, 60}},
      {"colour", 640, 480, {15, 30, 60}},
      {"colour", 640, 360, {15, 30, 60, 90}},
      {"colour", 480, 270, {15, 30, 60, 90}},
      {"colour", 424, 240, {15, 30, 60, 90}},
  };
  return all;
}

}  // namespace

std::vector<double> offered_rates_hz(std::string_view kind, std::int64_t width,
                                     std::int64_t height) {
  for (const Profile& profile : profiles()) {
    if (profile.kind == kind && profile.width == width && profile.height == height) {
      return profile.rates_hz;
    }
  }
  return {};
}

std::vector<std::string> offered_sizes(std::string_view kind) {
  std::vector<std::string> sizes;
  for (const Profile& profile : profiles()) {
    if (profile.kind == kind) sizes.push_back(fmt::format("{}x{}", profile.width, profile.height));
  }
  return sizes;
}

}  // namespace simbench::scenarios
