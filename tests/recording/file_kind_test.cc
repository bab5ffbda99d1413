#include "recording/file_kind.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <string>

#include "tests/scratch_folder.h"

namespace simbench {
namespace {

using namespace std::string_literals;

std::string kind_of(const std::string& content) {
  const ScratchFolder folder;
  return std::string(lasting_kind(folder.write("x", content)).value_or("none"));
}

TEST(LastingKind, IsKnownByTheFirstBytes) {
  EXPECT_EQ(kind_of("#ROSBAG V2.0\nrest"), "a rosbag 2.0 bag");
  EXPECT_EQ(kind_of("\x89MCAP0\r\nrest"), "an MCAP file");
  EXPECT_EQ(kind_of("SQLite format 3\0rest"s), "an SQLite file");
  EXPECT_EQ(kind_of("\x93NUMPY\x01\x00"s), "a NumPy array");
  EXPECT_EQ(kind_of("\x1a\x45\xdf\xa3rest"), "a Matroska file");
  EXPECT_EQ(kind_of("\0\0\0\x18"s + "ftypmp42"), "an MP4 file");
  EXPECT_EQ(kind_of("\0\0\0\x08"s + "wide"), "a QuickTime file");
  EXPECT_EQ(kind_of("\x89HDF\r\n\x1a\nrest"), "an HDF5 file");
  EXPECT_EQ(kind_of("PK\x03\x04rest"), "a zip file");
  EXPECT_EQ(kind_of("\x1f\x8b\x08rest"), "a gzip file");
  EXPECT_EQ(kind_of("\x28\xb5\x2f\xfdrest"), "a zstd file");
  EXPECT_EQ(kind_of("\x7f"s + "ELFrest"), "a program");
  EXPECT_EQ(kind_of("\xd4\xc3\xb2\xa1rest"), "a pcap file");
  EXPECT_EQ(kind_of("\x0a\x0d\x0d\x0arest"), "a pcapng file");
  EXPECT_EQ(kind_of("Stream Type,Index,F#"), "a CSV recording");
  EXPECT_EQ(kind_of("order,camera,stream"), "a part of a recording folder");
  EXPECT_EQ(kind_of(std::string(1000, 'x') + '\0'), "a binary file");
}

TEST(LastingKind, WhatARunHasWrittenHasNone) {
  for (const char* const text :
       {"", "set,complete,camera", "<!doctype html>", "<?xml version=\"1.0\"?><svg/>", "{\"name\"",
        "PK", "#ROSBAG V2", "Stream Typ", "cam_wide,cam_tele"}) {
    EXPECT_EQ(kind_of(text), "none") << text;
  }
  EXPECT_EQ(kind_of("%PDF-1.5\n\0\0"s), "none");
  EXPECT_EQ(kind_of(std::string(4096, 'x') + '\0'), "none");  // looks at no more
}

TEST(LastingKind, OnlyFilesHaveOne) {
  const ScratchFolder folder;
  EXPECT_FALSE(lasting_kind(folder / "missing"));
  EXPECT_FALSE(lasting_kind(folder.path()));
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(lasting_kind(folder / "pipe"));
}

}  // namespace
}  // namespace simbench
