// Rig files: what is read, and every refusal with its exact message.
#include "hardware/rig/rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using scenarios::InputError;
using testing::HasSubstr;

// A rig of `hosts`, whose members begin on line 3.
std::string rig_of(const std::string& hosts, const std::string& more = "") {
  return "{\"schema_version\": 1,\n \"name\": \"studio\", \"hosts\": [\n" + hosts + "]" + more +
         "}";
}

std::string host_entry(const std::string& name, const std::string& address,
                       const std::string& cameras = "", const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "address": ")" + address + "\"" + more +
         ", \"cameras\": [" + cameras + "]}";
}

std::string error_of(const std::string& text) {
  try {
    load_rig_text(text, "rigs/my.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RigTest, ReadsHostsCamerasAndTrigger) {
  const Rig rig = load_rig_text(
      rig_of(
          host_entry("host0", "10.0.0.10", R"({"serial": "018322071234"})") + ",\n" +
              host_entry("host1", "fd00::2",
                         R"({"serial": "demo", "recording": "left.csv", "recorded_camera": "c 1",)"
                         R"( "trigger_file": "../go"}, {"serial": "b", "recording": "/data/rec"})",
                         R"(, "port": 5000)"),
          R"(, "trigger": {"on_command": "trigger on", "off_command": "trigger off"})"),
      "rigs/my.json");
  EXPECT_EQ(rig.name, "studio");
  EXPECT_EQ(rig.file, "rigs/my.json");
  ASSERT_EQ(rig.hosts.size(), 2u);
  EXPECT_EQ(rig.hosts[0], (RigHost{.name = "host0",
                                   .address = "10.0.0.10",
                                   .port = kDefaultPort,
                                   .cameras = {{.serial = "018322071234"}}}));
  EXPECT_EQ(rig.hosts[1], (RigHost{.name = "host1",
                                   .address = "fd00::2",
                                   .port = 5000,
                                   .cameras = {{.serial = "demo",
                                                .recording = "rigs/left.csv",
                                                .recorded_camera = "c 1",
                                                .trigger_file = "go"},
                                               {.serial = "b", .recording = "/data/rec"}}}));
  EXPECT_EQ(
      rig.trigger,
      (RigTrigger{.manual = false, .on_command = "trigger on", .off_command = "trigger off"}));
}

TEST(RigTest, ReadsAManualTriggerOrNone) {
  const std::string hosts = host_entry("a", "127.0.0.1");
  EXPECT_EQ(load_rig_text(rig_of(hosts, R"(, "trigger": "manual")"), "r").trigger,
            (RigTrigger{.manual = true, .on_command = "", .off_command = ""}));
  EXPECT_FALSE(load_rig_text(rig_of(hosts), "r").trigger);
  EXPECT_EQ(load_rig_text(rig_of(hosts), "r").hosts[0].cameras.size(), 0u);
}

TEST(RigTest, AFileWithoutFolderIsRelativeToTheWorkingFolder) {
  const Rig rig = load_rig_text(
      rig_of(host_entry("a", "::1", R"({"serial": "x", "recording": "./rec/../left.csv"})")),
      "rig.json");
  EXPECT_EQ(rig.hosts[0].cameras[0].recording, "left.csv");
}

TEST(RigTest, LoopbackIsThisMachinesOwnAddressesOnly) {
  const auto loopback = [](const std::string& address) {
    const std::string hosts = host_entry("a", "127.0.0.1") + "," + host_entry("b", address);
    try {
      check_rig_is_guarded(load_rig_text(rig_of(hosts), "r"), /*has_key=*/false);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  EXPECT_TRUE(loopback("127.0.0.2"));
  EXPECT_TRUE(loopback("::1"));
  EXPECT_FALSE(loopback("10.0.0.1"));
  EXPECT_FALSE(loopback("128.0.0.1"));
  EXPECT_FALSE(loopback("fe80::1"));
  EXPECT_FALSE(loopback("::ffff:10.0.0.1"));
  EXPECT_FALSE(loopback("localhost"));
}

TEST(RigTest, FindsHostsByName) {
  const Rig rig = load_rig_text(
      rig_of(host_entry("left", "127.0.0.1") + "," + host_entry("right", "::1")), "r.json");
  EXPECT_EQ(host_named(rig, "left"), 0u);
  EXPECT_EQ(host_named(rig, "right"), 1u);
  const auto error_for = [&](const std::string& name) -> std::string {
    try {
      host_named(rig, name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_for("rigth"),
            "r.json: /hosts: found no host named \"rigth\", did you mean right?");
  EXPECT_EQ(error_for("top"), "r.json: /hosts: found no host named \"top\", allowed left, right");
}

TEST(RigErrors, NoJsonAndWrongShape) {
  EXPECT_THAT(error_of("{"), HasSubstr("rigs/my.json:1:"));
  EXPECT_THAT(error_of("{"), HasSubstr("broken JSON"));
  EXPECT_THAT(error_of(""), HasSubstr("nothing in it"));
  EXPECT_EQ(error_of("[]"), "rigs/my.json:1: found an array of 0, allowed an object");
  EXPECT_EQ(error_of(R"({"schema_version": 2, "name": "a")"
                     ",\n\"hosts\": [1]}"),
            "rigs/my.json:1: /schema_version: found 2, allowed a whole number equal to 1");
  EXPECT_EQ(error_of(rig_of("")),
            "rigs/my.json:2: /hosts: found an array of 0, allowed an array of 1 to 1000");
  EXPECT_EQ(error_of(rig_of("7")), "rigs/my.json:3: /hosts/0: found 7, allowed an object");
}

TEST(RigErrors, UnknownAndMissingMembers) {
  EXPECT_EQ(error_of(R"({"schema_version": 1, "name": "a"})"),
            "rigs/my.json:1: /hosts: found nothing, allowed an array of 1 to 1000");
  EXPECT_EQ(error_of(rig_of(R"({"name": "a", "adress": "::1", "cameras": []})")),
            "rigs/my.json:3: /hosts/0/adress: found an unknown key, did you mean address?");
  EXPECT_EQ(error_of(rig_of(R"({"name": "a", "cameras": []})")),
            "rigs/my.json:3: /hosts/0/address: found nothing, allowed text of 1 to 253 characters");
  EXPECT_EQ(error_of(rig_of(R"({"address": "::1", "cameras": []})")),
            "rigs/my.json:3: /hosts/0/name: found nothing, allowed text of 1 to 64 characters");
  EXPECT_EQ(error_of(rig_of(host_entry("", "::1"))),
            "rigs/my.json:3: /hosts/0/name: found \"\", allowed text of 1 to 64 characters");
  EXPECT_EQ(error_of(rig_of(host_entry("a", "::1", R"({"serials": "5"})"))),
            "rigs/my.json:3: /hosts/0/cameras/0/serials: found an unknown key, did you mean "
            "serial?");
}

TEST(RigErrors, NamesAndSerialNumbersStandOnce) {
  EXPECT_EQ(error_of(rig_of(host_entry("a", "10.0.0.1") + ",\n" + host_entry("a", "10.0.0.2"))),
            "rigs/my.json:4: /hosts/1/name: found the host name a again, which is that of "
            "/hosts/0/name (line 3); allowed one host of each name");
  EXPECT_EQ(
      error_of(rig_of(host_entry("a", "10.0.0.1", R"({"serial": "77"})") + ",\n" +
                      host_entry("b", "10.0.0.2", "{\"serial\": \"78\"},\n{\"serial\": \"77\"}"))),
      "rigs/my.json:5: /hosts/1/cameras/1/serial: found the serial number 77 again, which is "
      "that of /hosts/0/cameras/0/serial (line 3); allowed each camera once, on one host");
}

TEST(RigErrors, AddressesAndPorts) {
  const auto address_error = [](const std::string& address) {
    return error_of(rig_of(host_entry("a", address)));
  };
  for (const char* const bad : {"10.0.0.300", "10.0.0", "1", "10.0.0.1:5000", "[::1]", "fd00::xyz",
                                "a..b", "-a", "a b", "http://a", "a_b", "host."}) {
    EXPECT_EQ(address_error(bad), std::string("rigs/my.json:3: /hosts/0/address: found \"") + bad +
                                      "\", allowed an IPv4 or IPv6 address or the name of a host");
  }
  for (const char* const bad : {"0.0.0.0", "::", "224.0.0.1"}) {
    EXPECT_THAT(address_error(bad),
                HasSubstr("allowed the address at which the other hosts reach this one"));
  }
  for (const char* const good : {"10.0.0.1", "fd00::1", "localhost", "cam-3.example.org", "3com"}) {
    EXPECT_EQ(address_error(good), "");
  }
  EXPECT_EQ(error_of(rig_of(host_entry("a", "::1", "", R"(, "port": 0)"))),
            "rigs/my.json:3: /hosts/0/port: found 0, allowed a whole number from 1 to 65535");
  EXPECT_EQ(error_of(rig_of(host_entry("a", "::1", "", R"(, "port": 65536)"))),
            "rigs/my.json:3: /hosts/0/port: found 65536, allowed a whole number from 1 to 65535");
}

TEST(RigErrors, TwoHostsAtOnePlace) {
  EXPECT_EQ(
      error_of(rig_of(host_entry("a", "::1") + ",\n" + host_entry("b", "0:0:0:0:0:0:0:1"))),
      "rigs/my.json:4: /hosts/1/address: found the address and port ::1 port 47110 again, which is "
      "that of /hosts/0/address (line 3); allowed another address or another port for each host");
  EXPECT_EQ(error_of(rig_of(host_entry("a", "::1") + ",\n" +
                            host_entry("b", "::1", "", R"(, "port": 4000)"))),
            "");
}

TEST(RigErrors, CharactersThatNoNameHas) {
  EXPECT_EQ(error_of(rig_of(host_entry("a b", "::1"))),
            "rigs/my.json:3: /hosts/0/name: found \"a b\", allowed letters, digits, '.', '_' and "
            "'-'");
  EXPECT_EQ(error_of(rig_of(host_entry("a", "::1", R"({"serial": "1/2"})"))),
            "rigs/my.json:3: /hosts/0/cameras/0/serial: found \"1/2\", allowed letters, digits, "
            "'.', '_' and '-'");
  EXPECT_THAT(
      error_of(rig_of(host_entry("a", "::1", R"({"serial": "1", "recording": "a\u0000b"})"))),
      HasSubstr("/hosts/0/cameras/0/recording: found \"a\\u0000b\", allowed text without control"));
  EXPECT_THAT(error_of(rig_of(host_entry("a", "::1"),
                              R"(, "trigger": {"on_command": "a\nb", "off_command": "b"})")),
              HasSubstr("/trigger/on_command: found \"a\\nb\", allowed text without control"));
}

TEST(RigErrors, OnlyARecordedCameraHasARecordingsMembers) {
  EXPECT_EQ(error_of(rig_of(host_entry("a", "::1", R"({"serial": "1", "trigger_file": "go"})"))),
            "rigs/my.json:3: /hosts/0/cameras/0/trigger_file: found \"go\", allowed only beside "
            "\"recording\": a real camera has none");
  EXPECT_THAT(
      error_of(rig_of(host_entry("a", "::1", R"({"serial": "1", "recorded_camera": "l"})"))),
      HasSubstr("/hosts/0/cameras/0/recorded_camera: found \"l\", allowed only beside"));
}

TEST(RigErrors, Trigger) {
  const auto trigger_error = [](const std::string& trigger) {
    return error_of(rig_of(host_entry("a", "::1"), ",\n\"trigger\": " + trigger));
  };
  EXPECT_EQ(trigger_error("\"auto\""),
            "rigs/my.json:4: /trigger: found \"auto\", allowed \"manual\" or an object with "
            "on_command and off_command");
  EXPECT_THAT(trigger_error("5"), HasSubstr("rigs/my.json:4: /trigger: found 5, allowed"));
  EXPECT_THAT(trigger_error("null"), HasSubstr("rigs/my.json:4: /trigger: found null, allowed"));
  EXPECT_EQ(trigger_error(R"({"on_command": "on"})"),
            "rigs/my.json:4: /trigger/off_command: found nothing, allowed text of 1 to 4000 "
            "characters");
  EXPECT_EQ(trigger_error(R"({"on_command": "on", "off_comand": "x", "off_command": "off"})"),
            "rigs/my.json:4: /trigger/off_comand: found an unknown key, did you mean off_command?");
}

TEST(RigErrors, FilesThatCannotBeRead) {
  const auto file_error = [](const std::string& path) -> std::string {
    try {
      load_rig(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(file_error("/no/such/rig.json"),
            "/no/such/rig.json: cannot be read: No such file or directory");
  EXPECT_EQ(file_error("/"), "/: cannot be read: it is a folder");
  EXPECT_EQ(file_error("/dev/null"), "/dev/null: cannot be read: it is no regular file");
}

TEST(RigTest, LoadsAFileWithPathsBesideIt) {
  const ScratchFolder folder;
  const Rig rig = load_rig(folder.write(
      "rig.json", rig_of(host_entry("a", "::1", R"({"serial": "x", "recording": "l.csv"})"))));
  EXPECT_EQ(rig.hosts[0].cameras[0].recording, folder / "l.csv");
}

TEST(RigGuardTest, WithoutAKeyARigStaysOnLoopback) {
  const Rig home =
      load_rig_text(rig_of(host_entry("a", "127.0.0.1") + "," + host_entry("b", "::1")), "r");
  const Rig away = load_rig_text(
      rig_of(host_entry("a", "127.0.0.1") + "," + host_entry("b", "10.0.0.2")), "r.json");
  EXPECT_NO_THROW(check_rig_is_guarded(home, false));
  EXPECT_NO_THROW(check_rig_is_guarded(home, true));
  EXPECT_NO_THROW(check_rig_is_guarded(away, true));
  try {
    check_rig_is_guarded(away, false);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "r.json: /hosts/1/address: found \"10.0.0.2\" (b), which is not this machine's "
                 "loopback (127.0.0.1 or ::1); a rig without a key may not leave it: simbench "
                 "keygen rig.key, then --key-file rig.key");
  }
}

// A rig of 6 hosts of `cameras` cameras.
Rig studio(std::size_t cameras, bool has_trigger) {
  Rig rig{.name = "studio", .file = "r.json", .hosts = {}, .trigger = std::nullopt};
  for (int i = 0; i < 6; ++i) {
    RigHost one{.name = "host" + std::to_string(i), .address = "::1", .cameras = {}};
    one.cameras.resize(cameras);
    rig.hosts.push_back(one);
  }
  if (has_trigger) rig.trigger = RigTrigger{.manual = true, .on_command = "", .off_command = ""};
  return rig;
}

std::string misfit(const Rig& rig, const scenarios::Scenario& scenario) {
  try {
    check_rig_fits(rig, scenario);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RigFitTest, HostsCamerasAndTriggerMustAgree) {
  const auto scenario = scenarios::load_scenario("18cam_6host_45fps");
  EXPECT_EQ(misfit(studio(3, true), scenario), "");
  EXPECT_EQ(
      misfit(studio(3, false), scenario),
      "r.json: /trigger: found nothing, allowed \"manual\" or {\"on_command\": ..., "
      "\"off_command\": ...}: scenario 18cam_6host_45fps has sync mode genlock, whose cameras "
      "wait for a trigger");
  EXPECT_EQ(misfit(studio(2, true), scenario),
            "r.json: /hosts/0/cameras: found 2 cameras on host0, allowed 3: as many as scenario "
            "18cam_6host_45fps has there");
  Rig small = studio(3, true);
  small.hosts.pop_back();
  EXPECT_EQ(misfit(small, scenario),
            "r.json: /hosts: found 5 hosts, allowed 6: as many as scenario 18cam_6host_45fps has");
}

TEST(RigFitTest, OnlySomeSyncModesNeedATrigger) {
  auto scenario = scenarios::load_scenario("18cam_6host_45fps");
  using enum scenarios::SyncMode;
  for (const scenarios::SyncMode mode : {kSlave, kFullSlave, kGenlock}) {
    scenario.cameras.sync_mode = mode;
    EXPECT_THAT(misfit(studio(3, false), scenario), HasSubstr("/trigger")) << to_text(mode);
  }
  for (const scenarios::SyncMode mode : {kDefault, kMaster}) {
    scenario.cameras.sync_mode = mode;
    EXPECT_EQ(misfit(studio(3, false), scenario), "") << to_text(mode);
  }
}

TEST(RigFitTest, CamerasAreNumberedHostByHost) {
  auto scenario = scenarios::load_scenario("18cam_6host_45fps");
  for (std::int64_t camera = 0; camera < 18; ++camera) {
    scenario.cameras.host_of_camera.push_back(camera % 6);
  }
  EXPECT_EQ(misfit(studio(3, true), scenario),
            "r.json: /hosts/0/cameras/1: found camera 1 on host 0, allowed only on host 1, where "
            "scenario 18cam_6host_45fps has it: a rig's cameras are numbered host by host");
}

TEST(RigSchemaTest, IsTheOneBesideTheSources) {
  const std::string text = content(std::string(SIMBENCH_SOURCE_DIR) + "/hardware/rig/schema.json");
  EXPECT_FALSE(text.empty());
  EXPECT_EQ(rig_schema_text(), text);
}

}  // namespace
}  // namespace simbench::hardware
