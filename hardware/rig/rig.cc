#include "hardware/rig/rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "recording/counted.h"
#include "scenarios/document.h"
#include "scenarios/schema.h"

namespace simbench::hardware {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using scenarios::InputError;
using scenarios::PlacedDocument;
using scenarios::Scenario;
using scenarios::shown_text;

std::string read_rig_text(const std::string& path) {
  std::error_code ignored;
  if (fs::is_other(path, ignored))
    scenarios::fail_to_read(shown_text(path), "it is no regular file");
  return scenarios::read_input_file(path, shown_text(path), "rig");
}

// A rig file as JSON that the schema accepts; RigReader checks the rest.
PlacedDocument parse_rig_document(const std::string& text, const std::string& path) {
  static const scenarios::JsonSchema schema(json::parse(rig_schema_text()));
  PlacedDocument document = scenarios::parse_placed(text, {.label = shown_text(path)});
  scenarios::validate(document.root, schema, document.places);
  return document;
}

std::optional<boost::asio::ip::address> numeric(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  if (error) return std::nullopt;
  return parsed;
}

bool is_alphanumeric(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Letters, digits and those of `others`.
bool consists_of(const std::string& text, std::string_view others) {
  return std::all_of(text.begin(), text.end(), [others](char c) {
    return is_alphanumeric(c) || others.find(c) != std::string_view::npos;
  });
}

// A host name by RFC 1123: labels of letters, digits and hyphens, the last of which is no number,
// so that a mistyped address is no name.
bool is_host_name(const std::string& text) {
  if (!consists_of(text, "-.") || text.find("..") != std::string::npos) return false;
  if (!is_alphanumeric(text.front()) || !is_alphanumeric(text.back())) return false;
  const std::string last = text.substr(text.rfind('.') + 1);
  return !std::all_of(last.begin(), last.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Reads a document that the schema accepts, and checks what a schema cannot.
class RigReader {
 public:
  RigReader(const PlacedDocument& document, const std::string& path)
      : document_(document), folder_(fs::path(path).parent_path()) {
    rig_.file = path;
  }

  Rig read() {
    rig_.name = plain_text(document_.root.at("name"), "/name");
    const json& hosts = document_.root.at("hosts");
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      read_host(hosts[i], fmt::format("/hosts/{}", i));
    }
    if (const auto trigger = document_.root.find("trigger"); trigger != document_.root.end()) {
      read_trigger(*trigger);
    }
    return std::move(rig_);
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const {
    throw InputError(document_.places.describe(pointer) + ": " + problem);
  }

  // Throws if the value occurred before.
  void check_unique(const std::string& kind, const std::string& value, const std::string& pointer,
                    const std::string& allowed) {
    const auto [earlier, is_new] = seen_.try_emplace({kind, value}, pointer);
    if (is_new) return;
    fail(pointer, fmt::format("found the {} {} again, which is that of {} (line {}); allowed {}",
                              kind, shown_text(value), earlier->second,
                              document_.places.nearest(earlier->second).line, allowed));
  }

  void check_characters(const std::string& value, const std::string& pointer) const {
    if (consists_of(value, "._-")) return;
    fail(pointer,
         fmt::format("found \"{}\", allowed letters, digits, '.', '_' and '-'", shown_text(value)));
  }

  void read_host(const json& in, const std::string& pointer) {
    RigHost host;
    host.name = in.at("name").get<std::string>();
    host.address = in.at("address").get<std::string>();
    host.port = in.value("port", kDefaultPort);
    check_characters(host.name, pointer + "/name");
    check_unique("host name", host.name, pointer + "/name", "one host of each name");
    check_address(host, pointer);
    const json& cameras = in.at("cameras");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      host.cameras.push_back(read_camera(cameras[i], fmt::format("{}/cameras/{}", pointer, i)));
    }
    rig_.hosts.push_back(std::move(host));
  }

  void check_address(const RigHost& host, const std::string& pointer) {
    const auto address = numeric(host.address);
    if (!address && !is_host_name(host.address)) {
      fail(pointer + "/address",
           fmt::format("found \"{}\", allowed an IPv4 or IPv6 address or the name of a host",
                       shown_text(host.address)));
    }
    if (address && (address->is_unspecified() || address->is_multicast())) {
      fail(pointer + "/address",
           fmt::format("found \"{}\", allowed the address at which the other hosts reach this one",
                       host.address));
    }
    const std::string place = address ? address->to_string() : host.address;
    check_unique("address and port", fmt::format("{} port {}", place, host.port),
                 pointer + "/address", "another address or another port for each host");
  }

  RigCamera read_camera(const json& in, const std::string& pointer) {
    RigCamera camera;
    camera.serial = in.at("serial").get<std::string>();
    check_characters(camera.serial, pointer + "/serial");
    check_unique("serial number", camera.serial, pointer + "/serial",
                 "each camera once, on one host");
    if (!in.contains("recording")) {
      for (const char* const member : {"recorded_camera", "trigger_file"}) {
        if (!in.contains(member)) continue;
        fail(scenarios::child_pointer(pointer, member),
             fmt::format("found {}, allowed only beside \"recording\": a real camera has none",
                         scenarios::shown(in.at(member))));
      }
      return camera;
    }
    camera.recording = path_of(in.at("recording"), pointer + "/recording");
    if (in.contains("recorded_camera")) {
      camera.recorded_camera = plain_text(in.at("recorded_camera"), pointer + "/recorded_camera");
    }
    if (in.contains("trigger_file")) {
      camera.trigger_file = path_of(in.at("trigger_file"), pointer + "/trigger_file");
    }
    return camera;
  }

  // Text without control characters, which would spoil shells, files and tables.
  std::string plain_text(const json& in, const std::string& pointer) const {
    auto text = in.get<std::string>();
    const bool is_plain = std::none_of(text.begin(), text.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
    if (!is_plain) {
      fail(pointer,
           fmt::format("found {}, allowed text without control characters", scenarios::shown(in)));
    }
    return text;
  }

  // A path relative to the rig file's folder.
  std::string path_of(const json& in, const std::string& pointer) const {
    return (folder_ / plain_text(in, pointer)).lexically_normal().string();
  }

  void read_trigger(const json& in) {
    if (in.is_string()) {
      if (in != "manual") {
        fail(
            "/trigger",
            fmt::format("found {}, allowed \"manual\" or an object with on_command and off_command",
                        scenarios::shown(in)));
      }
      rig_.trigger = RigTrigger{.manual = true, .on_command = "", .off_command = ""};
      return;
    }
    rig_.trigger =
        RigTrigger{.manual = false,
                   .on_command = plain_text(in.at("on_command"), "/trigger/on_command"),
                   .off_command = plain_text(in.at("off_command"), "/trigger/off_command")};
  }

  const PlacedDocument& document_;
  fs::path folder_;
  Rig rig_;
  std::map<std::pair<std::string, std::string>, std::string> seen_;  // (kind, value) -> pointer
};

bool is_loopback(const std::string& address) {
  const auto parsed = numeric(address);
  return parsed && parsed->is_loopback();
}

[[noreturn]] void fail(const Rig& rig, const std::string& pointer, const std::string& problem) {
  throw InputError(fmt::format("{}: {}: {}", scenarios::shown_text(rig.file), pointer, problem));
}

void check_cameras(const Rig& rig, const Scenario& scenario) {
  const std::vector<std::size_t> wanted = scenario.cameras_by_host();
  for (std::size_t i = 0; i < rig.hosts.size(); ++i) {
    const std::size_t found = rig.hosts[i].cameras.size();
    if (found == wanted[i]) continue;
    fail(rig, fmt::format("/hosts/{}/cameras", i),
         fmt::format("found {} on {}, allowed {}: as many as scenario {} has there",
                     counted(found, "camera"), rig.hosts[i].name, wanted[i], scenario.name));
  }
  std::int64_t camera = 0;
  for (std::size_t i = 0; i < rig.hosts.size(); ++i) {
    for (std::size_t j = 0; j < rig.hosts[i].cameras.size(); ++j, ++camera) {
      if (scenario.host_of(camera) == static_cast<std::int64_t>(i)) continue;
      fail(rig, fmt::format("/hosts/{}/cameras/{}", i, j),
           fmt::format("found camera {} on host {}, allowed only on host {}, where scenario {} has "
                       "it: a rig's cameras are numbered host by host",
                       camera, i, scenario.host_of(camera), scenario.name));
    }
  }
}

}  // namespace

Rig load_rig(const std::string& path) { return load_rig_text(read_rig_text(path), path); }

Rig load_rig_text(const std::string& text, const std::string& path) {
  const PlacedDocument document = parse_rig_document(text, path);
  return RigReader(document, path).read();
}

PeerId host_named(const Rig& rig, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < rig.hosts.size(); ++i) {
    if (rig.hosts[i].name == name) return static_cast<PeerId>(i);
    names.push_back(rig.hosts[i].name);
  }
  const std::vector<std::string> similar = scenarios::nearest(name, names);
  constexpr std::size_t kMostListed = 50;
  const bool cut = similar.empty() && names.size() > kMostListed;
  if (cut) names.resize(kMostListed);
  throw InputError(
      fmt::format("{}: /hosts: found no host named \"{}\", {} {}{}", shown_text(rig.file),
                  shown_text(name), similar.empty() ? "allowed" : "did you mean",
                  fmt::join(similar.empty() ? names : similar, similar.empty() ? ", " : " or "),
                  cut ? ", ..." : (similar.empty() ? "" : "?")));
}

void check_rig_is_guarded(const Rig& rig, bool has_key) {
  if (has_key) return;
  for (std::size_t i = 0; i < rig.hosts.size(); ++i) {
    const RigHost& host = rig.hosts[i];
    if (is_loopback(host.address)) continue;
    throw InputError(fmt::format(
        "{}: /hosts/{}/address: found \"{}\" ({}), which is not this machine's loopback "
        "(127.0.0.1 or ::1); a rig without a key may not leave it: simbench keygen rig.key, then "
        "--key-file rig.key",
        shown_text(rig.file), i, shown_text(host.address), host.name));
  }
}

void check_rig_fits(const Rig& rig, const Scenario& scenario) {
  if (static_cast<std::int64_t>(rig.hosts.size()) != scenario.hosts.count) {
    fail(rig, "/hosts",
         fmt::format("found {}, allowed {}: as many as scenario {} has",
                     counted(rig.hosts.size(), "host"), scenario.hosts.count, scenario.name));
  }
  check_cameras(rig, scenario);
  if (!scenario.cameras.groups.empty()) {
    fail(rig, "/hosts",
         fmt::format("found a rig for scenario {}, which has /cameras/groups, allowed scenarios of "
                     "one camera model: a node sets all cameras alike",
                     scenario.name));
  }
  if (waits_for_trigger(scenario.cameras.sync_mode) && !rig.trigger) {
    fail(rig, "/trigger",
         fmt::format("found nothing, allowed \"manual\" or {{\"on_command\": ..., \"off_command\": "
                     "...}}: scenario {} has sync mode {}, whose cameras wait for a trigger",
                     scenario.name, to_text(scenario.cameras.sync_mode)));
  }
}

}  // namespace simbench::hardware
