// Bags of a simulated rig, as the RealSense SDK's recorder would have written them: a file a
// camera.
//
//   std::vector<RecordedStream> rig = simulated_rig("6cam_2host_30fps", 1, 2400);
//   const std::string file = write_sdk_bag(rig.front(), folder.path());
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/pipeline_choice.h"
#include "recording/recorded_stream_sink.h"
#include "recording/recorded_streams.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/bags/rosbag_writer.h"

namespace simbench {

// The depth streams of triggered cameras on one host.
inline std::vector<RecordedStream> simulated_rig(std::uint64_t seed, int cameras, int frames) {
  const scenarios::Scenario scenario = scenarios::load_scenario(
      "6cam_2host_30fps", {{"/cameras/count", std::to_string(cameras)},
                           {"/cameras/cameras_per_host", std::to_string(cameras)},
                           {"/timeline/frames", std::to_string(frames)}});
  const auto choice = evaluation::choose_pipelines(scenario, {"genlock"}).front();
  const auto source = sim::make_simulation(scenario);
  RecordedStreamSink sink({});
  evaluation::record_run(*source, choice, seed, sink);
  return sink.take();
}

// One stream as a bag: images with the SDK's metadata.
inline std::string sdk_bag(const RecordedStream& stream, bags::RosbagWriter::Chunks chunks) {
  // When the recording began, by the host's clock.
  constexpr Nanoseconds kStart = std::chrono::milliseconds(1'790'000'000'000);
  bags::RosbagWriter writer(chunks, std::size_t{768} << 10);
  const auto info = writer.add_topic("/device_0/info", "diagnostic_msgs/KeyValue");
  writer.add_message(info, {}, bags::ros1_key_value("Serial Number", stream.camera));
  const std::string base = "/device_0/sensor_0/Depth_0/image/";
  const auto data = writer.add_topic(base + "data", "sensor_msgs/Image");
  const auto metadata = writer.add_topic(base + "metadata", "diagnostic_msgs/KeyValue");
  const Nanoseconds begin = stream.frames.front().arrival;
  Nanoseconds log{};
  for (const StampedFrame& frame : stream.frames) {
    log = std::max(log + Nanoseconds(1), frame.arrival - begin);
    writer.add_message(
        data, log,
        bags::ros1_header(static_cast<std::uint32_t>(frame.counter), frame.sensor, "1") +
            std::string(384, '\7'));
    const auto tell = [&](const char* name, std::int64_t value) {
      writer.add_message(metadata, log, bags::ros1_key_value(name, std::to_string(value)));
    };
    tell("Sensor Timestamp", frame.sensor.count() / 1000);
    tell("Time Of Arrival", (kStart + frame.arrival).count() / 1'000'000);
  }
  return writer.bag();
}

inline std::string write_sdk_bag(const RecordedStream& stream, const std::string& folder) {
  const std::string file = folder + "/" + stream.camera + ".bag";
  bags::write_bytes(file, sdk_bag(stream, bags::RosbagWriter::Chunks::kLz4));
  return file;
}

}  // namespace simbench
