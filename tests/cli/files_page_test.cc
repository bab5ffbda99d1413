// Every command of docs/files.md, on a small file of the form that it is for.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/bags/bag_writers.h"
#include "tests/cli/program.h"
#include "tests/data/file_forms.h"
#include "tests/deflated.h"

namespace simbench {
namespace {

using testing::IsEmpty;
using testing::Not;

// An MCAP with a camera.
std::string mcap() {
  bags::McapWriter mcap({.compression = "", .chunk_bytes = 0});
  const std::uint16_t left = mcap.channel("/left/image", "sensor_msgs/msg/Image", "cdr");
  for (std::uint32_t i = 0; i < forms::kLines; ++i) {
    mcap.message(left, 1'000'000'000ULL * i, bags::cdr_header(i, 0, "left"));
  }
  return mcap.close();
}

class FilesPage : public ProgramTest {};

TEST_F(FilesPage, EveryCommandRuns) {
  // In the place of FFmpeg's, which a machine may not have.
  std::filesystem::create_directory(folder() / "bin");
  file("bin/ffprobe", "#!/bin/sh\necho packet,0,0,1; echo packet,0,33,2; echo stream,0,1/1000\n");
  std::map<std::string, std::string> files = file_forms();
  files["rig_0.mcap.zstd"] = deflated("zstd", mcap());
  files["output.mkv"] = "\x1a\x45\xdf\xa3";
  for (const auto& [name, content] : files) {
    std::filesystem::create_directories((folder() / name).parent_path());
    file(name, content);
  }
  const std::vector<std::vector<std::string>> commands = commands_of_files_page();
  EXPECT_GT(commands.size(), 45U);
  std::filesystem::permissions(folder() / "bin/ffprobe", std::filesystem::perms::owner_all);
  const ProgramOptions with_ffprobe{
      .environment = {fmt::format("PATH={}:{}", (folder() / "bin").string(), std::getenv("PATH"))}};
  for (const std::vector<std::string>& command : commands) {
    const ProgramResult result = run(command, with_ffprobe);
    EXPECT_EQ(result.status, 0) << fmt::format("{}", fmt::join(command, " ")) << "\n" << result.err;
    EXPECT_THAT(result.out, Not(IsEmpty()));
  }
}

}  // namespace
}  // namespace simbench
