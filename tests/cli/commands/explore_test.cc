// `simbench explore` through the real program; what its page does is in tests/browser.
#include <gmock/gmock.h>

#include <string>

#include "tests/cli/program.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ExploreCommand : public ProgramTest {
 protected:
  std::string path_of(const std::string& name) const { return (folder() / name).string(); }

  void refuses(const std::vector<std::string>& words, const std::string& text) {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_THAT(result.out, testing::IsEmpty());
  }
};

TEST_F(ExploreCommand, RefusesWhatCannotBeExplored) {
  refuses({"explore", "18cam_6host_45fp"}, "did you mean 18cam_6host_45fps");
  refuses({"explore", path_of("none.json")}, "none.json");
  refuses({"explore", file("broken.json", "{")}, "broken.json:1");
  refuses({"explore", file("rig.csv", "a,b\n1,2\n")}, "rig.csv");
  refuses({"explore", "--port", "70000"}, "--port: found '70000', allowed");
  refuses({"explore", "--set", "/usb/spike_probability=7"}, "/usb/spike_probability");
}

TEST_F(ExploreCommand, ATourIsOneFile) {
  const std::string tour = path_of("tour.html");
  const ProgramResult result = run({"explore", "3cam_1host_30fps", "--export", tour, "--seeds", "2",
                                    "--sweep", "/cameras/exposure_ms=2,8"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("tour.html written"));
  const std::string html = content(tour);
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  EXPECT_THAT(html, HasSubstr("id=\"stored\""));
  EXPECT_LT(html.size(), 1'000'000u);
}

TEST_F(ExploreCommand, TheSameTourHasTheSameBytes) {
  std::string first;
  for (const char* const name : {"a.html", "b.html"}) {
    run({"explore", "3cam_1host_30fps", "--export", path_of(name), "--seeds", "2", "--sweep",
         "/usb/delivery_jitter_transfers=0:1:0.5"});
    if (first.empty()) first = content(path_of(name));
    EXPECT_TRUE(first == content(path_of(name)));
  }
}

TEST_F(ExploreCommand, ATourWithAHoleIsRefusedBeforeAnyWork) {
  const std::string tour = path_of("tour.html");
  const std::vector<std::string> begin = {"explore", "3cam_1host_30fps", "--export", tour};
  const auto with = [&begin](std::vector<std::string> more) {
    std::vector<std::string> words = begin;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  refuses(with({"--sweep", "/usb/spike_probability=0,7"}),
          "the world with /usb/spike_probability=7 cannot be");
  refuses(with({"--sweep", "/usb/nothing=0,1"}), "/usb/nothing");
  refuses(with({"--sweep", "/usb/spike_probability=0:1:0.0001"}), "worlds, allowed for --export");
  refuses(with({"--sweep", "/hosts/count=1:2:1+/cameras/count=3:6:3"}), "lockstep");
  EXPECT_FALSE(std::filesystem::exists(tour));
}

}  // namespace
}  // namespace simbench
