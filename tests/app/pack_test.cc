#include "app/pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "app/host_logs.h"
#include "app/recorded_streams.h"
#include "evaluation/diagnosis/diagnose.h"
#include "scenarios/document.h"
#include "tests/scratch_folder.h"

namespace simbench::app {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Two cameras of two hosts that follow one trigger; the names are a secret.
std::string secret_rig() {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";
  for (int i = 0; i < 400; ++i) {
    for (const char* const name : {"secret_left", "secret_right"}) {
      const double late = (i * 37 + name[8]) % 17 * 0.05;
      text += "Depth,0," + std::to_string(i) + ',' + std::to_string(1000 + i * 33.333) + ',' +
              std::to_string(5000 + i * 33.333 + late) + ',' + name + ",pc_" + name + '\n';
    }
  }
  return text;
}

std::string everything_in(const std::filesystem::path& folder) {
  std::string text;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    text += entry.path().filename().string() + '\n';
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    text.append(std::istreambuf_iterator<char>(file), {});
  }
  return text;
}

TEST(Pack, HasNoNamesAndTheSameDiagnosis) {
  const ScratchFolder scratch;
  const std::string rig = scratch.write("secret_rig.csv", secret_rig());
  const std::string log =
      scratch.write("secret.log", "time_s,error_s\n5,0.001\n6,0.002\n7,0.001\n");
  const RecordedStreams recorded = recorded_streams({rig});
  const std::string folder = (scratch.path() / "for_you").string();
  const Pack packed = pack_streams(recorded, host_logs({"pc_secret_left=" + log}).logs, folder);
  EXPECT_THAT(packed.notes, Contains("camera0 is secret_left"));
  EXPECT_THAT(packed.notes, Contains("host1 is pc_secret_right"));
  EXPECT_THAT(everything_in(folder), Not(HasSubstr("secret")));
  EXPECT_THAT(everything_in(folder), HasSubstr("host0.1.csv"));
  EXPECT_THAT(everything_in(folder), HasSubstr(",camera1,host1"));
  const RecordedStreams again = recorded_streams({folder + "/frames.csv"});
  ASSERT_EQ(again.streams.size(), recorded.streams.size());
  const evaluation::Diagnosis of_rig = evaluation::diagnose(recorded.streams, {});
  const evaluation::Diagnosis of_pack = evaluation::diagnose(again.streams, {});
  ASSERT_EQ(of_rig.cameras.size(), of_pack.cameras.size());
  ASSERT_EQ(of_rig.findings.size(), of_pack.findings.size());
  EXPECT_THROW(pack_streams(recorded, {}, folder), scenarios::InputError);
}

}  // namespace
}  // namespace simbench::app
