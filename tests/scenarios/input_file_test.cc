#include "scenarios/input_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "scenarios/document.h"
#include "tests/read_fault.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

using testing::HasSubstr;

std::string file_refusal(const std::function<void()>& reads) {
  try {
    reads();
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(InputFile, AWholeFileIsReadUpToItsLimit) {
  const ScratchFolder folder;
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 200'000U}) {
    const std::string text(size, 'x');
    const std::string path = folder.write("file", text);
    EXPECT_EQ(file_content(path, size), text) << size;
    if (size == 0) continue;
    EXPECT_THROW(file_content(path, size - 1), FileTooLarge) << size;
  }
}

TEST(InputFile, WhatIsNoFileIsRefusedAtOnce) {
  EXPECT_EQ(file_refusal([] { InputFile file("/"); }), "it is a folder");
  EXPECT_EQ(file_refusal([] { InputFile file("/dev/zero"); }), "it is a device");
  EXPECT_EQ(file_refusal([] { InputFile file("/no/such"); }), "No such file or directory");
  // Opens, and cannot be read.
  EXPECT_EQ(file_refusal([] { file_content("/proc/self/mem", 1000); }), "Input/output error");
}

TEST(InputFile, APipeIsReadToItsEndAndNoFurtherThanItsLimit) {
  std::signal(SIGPIPE, SIG_IGN);  // the writer's, when the reader has had enough
  const ScratchFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  for (const std::size_t limit : {300'000U, 100'000U}) {
    std::jthread writer([&] { std::ofstream(path) << std::string(200'000, 'x') << std::flush; });
    if (limit > 200'000) {
      EXPECT_EQ(file_content(path, limit).size(), 200'000U);
    } else {
      EXPECT_THROW(file_content(path, limit), FileTooLarge);
    }
  }
}

TEST(InputFile, APipeIsRefusedWhereOnlyAFileIsOfUse) {
  const ScratchFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(file_refusal([&] { InputFile file(path, Pipes::kRefused); }),
            "it is a pipe; allowed: a file");
  EXPECT_EQ(file_refusal([&] { file_content(path, 1000, Pipes::kRefused); }),
            "it is a pipe; allowed: a file");
}

TEST(InputFile, AReadErrorAtAnyByteIsAnError) {
  const ScratchFolder folder;
  const std::string path = folder.write("scenario.json", R"({"base": "18cam_6host_45fps"})");
  const std::size_t size = simbench::content(path).size();
  for (std::size_t byte = 0; byte <= size; ++byte) {  // the last: in place of the end
    const ReadFault fault(byte);
    EXPECT_EQ(file_refusal([&] { file_content(path, 1000); }), "Input/output error") << byte;
    EXPECT_THROW(scenarios::load_scenario(path), scenarios::InputError) << byte;
  }
}

}  // namespace
}  // namespace simbench
