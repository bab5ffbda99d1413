#include "sim/programs/program_file.h"

#include <elf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/xattr.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

#include "tests/scratch_folder.h"

namespace simbench::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string& real_program() {
  static const std::string kPath = std::string(SIMBENCH_PROGRAMS) + "/simbench_cristian";
  return kPath;
}

class ProgramFileTest : public testing::Test {
 protected:
  std::string executable(const std::string& text, mode_t mode = 0755) const {
    std::string path = folder_.write("program", text);
    chmod(path.c_str(), mode);
    return path;
  }
  // What is said of the file, without its name.
  static std::string refusal(const std::string& path) {
    try {
      program_command(path);
    } catch (const ProgramError& error) {
      EXPECT_THAT(error.what(), StartsWith(path + ": "));
      return std::string(error.what()).substr(path.size() + 2);
    }
    return "none";
  }
  // A real program in which `text` reads as `other`, which is not longer.
  std::string with_text(const std::string& text, std::string other) const {
    std::string program = content(real_program());
    const std::size_t at = program.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    other.resize(text.size());
    return executable(program.replace(at, other.size(), other));
  }

  const ScratchFolder folder_;
};

TEST_F(ProgramFileTest, AProgramStandsForItself) {
  EXPECT_THAT(program_command(real_program()), ElementsAre(real_program()));
}

TEST_F(ProgramFileTest, WhatIsNoProgramIsSaid) {
  EXPECT_EQ(refusal(folder_ / "missing"), "No such file or directory");
  EXPECT_EQ(refusal(folder_.path().string()), "is a folder");
  EXPECT_EQ(refusal("/dev/null"), "is no file");
  EXPECT_EQ(refusal(executable(content(real_program()), 0644)), "is not executable");
  for (const char* text : {"", "\x7f", "print('hello')\n"}) {
    EXPECT_EQ(refusal(executable(text)), "is neither a program nor a script that begins with #!");
  }
}

TEST_F(ProgramFileTest, AStaticProgramIsRefused) {
  std::string program = content(real_program());
  Elf64_Ehdr head{};
  std::memcpy(&head, program.data(), sizeof head);
  for (std::size_t i = 0; i < head.e_phnum; ++i) {
    const std::size_t at = head.e_phoff + i * sizeof(Elf64_Phdr);
    Elf64_Phdr part{};
    std::memcpy(&part, program.data() + at, sizeof part);
    if (part.p_type == PT_INTERP) part.p_type = PT_NULL;
    std::memcpy(program.data() + at, &part, sizeof part);
  }
  EXPECT_EQ(refusal(executable(program)), "is static: the preloaded library cannot reach it");
}

TEST_F(ProgramFileTest, GoIsRefusedByItsSections) {
  EXPECT_EQ(refusal(with_text(".eh_frame_hdr", ".go.buildinfo")),
            "is written in Go, which calls the kernel without the preloaded library");
}

TEST_F(ProgramFileTest, OtherMachinesAndLibrariesAreRefused) {
  std::string program = content(real_program());
  program[offsetof(Elf64_Ehdr, e_machine)] = EM_S390;
  EXPECT_EQ(refusal(executable(program)), "is for another architecture than this machine's");
  program = content(real_program());
  program[EI_CLASS] = ELFCLASS32;
  EXPECT_EQ(refusal(executable(program)), "is for another architecture than this machine's");
  program = content(real_program());
  program[offsetof(Elf64_Ehdr, e_type)] = ET_CORE;
  EXPECT_EQ(refusal(executable(program)), "is no program");
  EXPECT_THAT(refusal(with_text("/ld-linux", "/ld-musl")),
              StartsWith("is linked with another C library than glibc ("));
}

TEST_F(ProgramFileTest, RightsOfItsOwnAreRefused) {
  for (const mode_t mode : {04755, 02755}) {
    const std::string path = executable(content(real_program()), mode);
    EXPECT_THAT(refusal(path), StartsWith("has rights of its own (set-uid")) << std::oct << mode;
  }
  const std::string path = executable(content(real_program()));
  // Version 2, effective, CAP_SYS_TIME: capabilities(7).
  const std::array<std::uint32_t, 5> capability = {0x02000001, 1U << 25U, 0, 0, 0};
  if (setxattr(path.c_str(), "security.capability", capability.data(), sizeof capability, 0) != 0) {
    GTEST_SKIP() << "may not give file capabilities: " << std::strerror(errno);
  }
  EXPECT_THAT(refusal(path), StartsWith("has rights of its own (set-uid"));
}

TEST_F(ProgramFileTest, AScriptIsItsInterpreterAndItself) {
  const std::string path = executable("#!" + real_program() + "\n");
  EXPECT_THAT(program_command(path), ElementsAre(real_program(), path));
  executable("#! " + real_program() + "  -u -v \r\n");
  EXPECT_THAT(program_command(path), ElementsAre(real_program(), "-u -v", path))
      << "one argument, as the kernel has it";
  setenv("SIMBENCH_PROGRAMS", SIMBENCH_PROGRAMS, 1);
  executable("#!/usr/bin/env simbench_cristian");
  EXPECT_THAT(program_command(path), ElementsAre(real_program(), path));
  executable("#!/usr/bin/env -S simbench_cristian -u -v\n");
  EXPECT_THAT(program_command(path), ElementsAre(real_program(), "-u", "-v", path));
  unsetenv("SIMBENCH_PROGRAMS");
}

TEST_F(ProgramFileTest, AScriptWithoutAnInterpreterIsSaid) {
  EXPECT_EQ(refusal(executable("#!\n")), "its interpreter: none is named after #!");
  EXPECT_EQ(refusal(executable("#!/usr/bin/env\n")), "its interpreter: env without a name");
  EXPECT_EQ(refusal(executable("#!/no/such/thing -x\n")),
            "its interpreter: /no/such/thing: No such file or directory");
  EXPECT_THAT(refusal(executable("#!bin/sh\n")), HasSubstr("found \"bin/sh\", a relative path"));
  EXPECT_THAT(refusal(executable("#!" + (folder_ / "program") + "\n")),
              HasSubstr("is a script too"));
}

// Any bytes are looked at without harm: they are a program or a ProgramError.
TEST_F(ProgramFileTest, DamagedProgramsDoNoHarm) {
  constexpr std::uint64_t kSeed = 1;
  constexpr int kFiles = 300;
  const std::string program = content(real_program());
  std::mt19937_64 random(kSeed);
  int refused = 0;
  for (int i = 0; i < kFiles; ++i) {
    std::string damaged = program;
    for (int change = 0; change < 8; ++change) {
      // The file's head, those of its parts, and the rest, at whose end are those of its sections.
      const std::size_t sizes[] = {64, 1024, program.size(), program.size()};
      damaged[random() % sizes[change % 4]] = static_cast<char>(random());
    }
    if (i % 3 == 0) damaged.resize(random() % damaged.size());
    refused += refusal(executable(damaged)) != "none" ? 1 : 0;
  }
  EXPECT_GT(refused, kFiles / 10) << "seed " << kSeed;
  EXPECT_LT(refused, kFiles) << "seed " << kSeed;
}

}  // namespace
}  // namespace simbench::sim
