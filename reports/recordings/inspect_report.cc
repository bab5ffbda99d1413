#include "reports/recordings/inspect_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/frames/camera_statistics.h"
#include "recording/counted.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/archive/archive.h"
#include "reports/recordings/stream_blocks.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::StreamFacts;

constexpr std::uint64_t kFewMessages = 3;  // what has fewer says what a recording is, not when

struct InspectedStream {
  const RecordedStream* stream;
  StreamFacts facts;
};

std::vector<InspectedStream> inspected(const Inspection& file) {
  std::vector<InspectedStream> streams;
  streams.reserve(file.recording.streams.size());
  for (const RecordedStream& stream : file.recording.streams) {
    streams.push_back({&stream, evaluation::stream_facts(stream)});
  }
  return streams;
}

std::string format_of(const Inspection& file) {
  return file.bag ? file.bag->facts.description : "stamps of cameras";
}

Table streams_table(const std::vector<InspectedStream>& streams) {
  Table table({{"camera", Align::kLeft},
               {"stream", Align::kLeft},
               {"rate\nHz"},
               {"span\ns"},
               {"longest\ngap s"},
               {"stamps", Align::kLeft},
               {"arrivals", Align::kLeft}},
              2);
  for (const auto& [stream, facts] : streams) {
    table.add({stream->camera, stream->stream, decimals_text(1000 / facts.period_ms, 3),
               number_text(facts.span_s()), number_text(facts.longest_gap_s),
               stream->origin.stamps.empty() ? "of the file" : stream->origin.stamps,
               stream->origin.arrivals.empty() ? "of the file" : stream->origin.arrivals});
  }
  return table;
}

Table topics_table(const std::vector<bags::TopicScan>& topics) {
  Table table({{"topic", Align::kLeft},
               {"type", Align::kLeft},
               {"messages"},
               {"rate\nHz"},
               {"MB"},
               {"longest\ngap s"}});
  constexpr double kMegabyte = 1e6;
  for (const bags::TopicScan& scan : topics) {
    if (scan.messages < kFewMessages) continue;
    table.add({printable_name(scan.topic.name),
               scan.topic.type.empty() ? "unknown" : printable_name(scan.topic.type),
               count_text(static_cast<std::int64_t>(scan.messages)), number_text(scan.rate_hz()),
               number_text(static_cast<double>(scan.bytes) / kMegabyte),
               number_text(to_seconds(scan.longest_gap))});
  }
  return table;
}

std::vector<std::string> head_of(const Inspection& file) {
  std::vector<std::string> head = {fmt::format("{}: {}", file.file, format_of(file))};
  if (!file.bag) return head;
  const bags::BagFacts& facts = file.bag->facts;
  head.front() += fmt::format(", {}, {}", counted(facts.messages, "message"),
                              facts.indexed ? "closed properly" : "not closed properly");
  if (facts.lost_bytes > 0) {
    head.front() += fmt::format(
        ", {} lost to damage{}", counted(facts.lost_bytes, "byte"),
        facts.lost_messages ? fmt::format(" ({})", counted(*facts.lost_messages, "message")) : "");
  }
  if (!file.bag->devices.empty()) {
    head.push_back(fmt::format("{}", fmt::join(file.bag->devices, "; ")));
  }
  return head;
}

std::vector<std::string> inspection_notes(const Inspection& file) {
  std::vector<std::string> notes = file.recording.notes;
  for (const RecordedStream& stream : file.recording.streams) {
    std::ranges::move(evaluation::doubts_of(stream), std::back_inserter(notes));
  }
  return notes;
}

// How a bag without streams of a camera can be read.
std::string topics_proposal(const Inspection& file) {
  std::vector<std::string> topics = bags::headed_topics(*file.bag);
  if (topics.empty()) {
    return "No topic looks like a camera's, and none has messages that begin with a header.";
  }
  for (std::string& topic : topics) topic = printable_name(topic);
  return fmt::format(
      "No topic looks like a camera's. The messages of some begin with a header, whose stamps can "
      "be "
      "read: {}",
      simbench_line({"simbench", "diagnose", file.file, "--topics",
                     fmt::format("{}", fmt::join(topics, ","))}));
}

// What to do with the files, and with each folder. A heading is not broken into lines.
std::vector<Block> next_blocks(const std::vector<Inspection>& files,
                               const std::vector<std::string>& reading) {
  std::vector<Block> blocks;
  const auto propose = [&](const std::vector<std::string>& inputs) {
    std::vector<std::string> words = {"simbench", "diagnose"};
    words.insert(words.end(), inputs.begin(), inputs.end());
    words.insert(words.end(), reading.begin(), reading.end());
    blocks.push_back({.heading = "Next: " + simbench_line(std::move(words))});
  };
  std::vector<std::string> rig;
  for (const Inspection& file : files) {
    if (!file.is_folder && !file.recording.streams.empty()) rig.push_back(file.file);
  }
  if (!rig.empty()) propose(rig);
  for (const Inspection& file : files) {
    if (file.is_folder) propose({file.file});
  }
  return blocks;
}

}  // namespace

Document inspect_document(const std::vector<Inspection>& files,
                          const std::vector<std::string>& reading) {
  Document document;
  for (const Inspection& file : files) {
    Block block{.prose = head_of(file)};
    const std::vector<InspectedStream> streams = inspected(file);
    document.blocks.push_back(std::move(block));
    if (!streams.empty()) {
      document.blocks.push_back({.heading = "Streams", .table = streams_table(streams)});
      document.blocks.push_back(frames_block(file.recording.streams));
      document.blocks.push_back(clocks_block(file.recording.streams));
      if (!file.stamps.empty()) document.blocks.push_back(stamps_block(file.stamps));
    }
    if (file.bag) {
      Block topics{.heading = "Topics", .table = topics_table(file.bag->topics)};
      const auto others = file.bag->topics.size() - topics.table->rows.size();
      if (others > 0) {
        topics.prose = {fmt::format("and {} with one or two messages", counted(others, "topic"))};
      }
      document.blocks.push_back(std::move(topics));
    }
    Block last{.items = inspection_notes(file)};
    if (streams.empty() && file.bag) last.prose = {topics_proposal(file)};
    document.blocks.push_back(std::move(last));
  }
  std::ranges::move(next_blocks(files, reading), std::back_inserter(document.blocks));
  return document;
}

std::string inspect_json(const std::vector<Inspection>& files) {
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"files", Json::array()}};
  for (const Inspection& file : files) {
    Json entry = {{"file", file.file},        {"format", format_of(file)},
                  {"closed", nullptr},        {"lost_bytes", nullptr},
                  {"lost_messages", nullptr}, {"devices", Json::array()},
                  {"streams", Json::array()}, {"stamps", Json::array()},
                  {"topics", Json::array()},  {"notes", inspection_notes(file)}};
    for (const auto& [stream, facts] : inspected(file)) {
      entry["streams"].push_back({{"camera", stream->camera},
                                  {"host", stream->host},
                                  {"stream", stream->stream},
                                  {"topic", printable_name(stream->origin.topic)},
                                  {"frames", facts.account.delivered},
                                  {"span_s", facts.span_s()},
                                  {"rate_hz", 1000 / facts.period_ms},
                                  {"counted", stream->counted},
                                  {"lost_frames", facts.account.lost},
                                  {"never_exposed_frames", facts.account.never_exposed},
                                  {"unknown_frames", facts.account.unknown},
                                  {"longest_gap_s", facts.longest_gap_s},
                                  {"gap_at_s", facts.gap_at_s},
                                  {"stamps", stream->origin.stamps},
                                  {"arrivals", stream->origin.arrivals},
                                  {"stamped_by_host", stream->stamped_by_host},
                                  {"clocks", clocks_json(*stream)}});
    }
    for (const evaluation::StampedStream& stamped : file.stamps) {
      entry["stamps"].push_back(stamps_json(stamped));
    }
    if (file.bag) {
      const bags::BagFacts& facts = file.bag->facts;
      entry["closed"] = facts.indexed;
      entry["lost_bytes"] = facts.lost_bytes;
      if (facts.lost_messages) entry["lost_messages"] = *facts.lost_messages;
      entry["devices"] = file.bag->devices;
      for (const bags::TopicScan& scan : file.bag->topics) {
        entry["topics"].push_back({{"topic", printable_name(scan.topic.name)},
                                   {"type", printable_name(scan.topic.type)},
                                   {"publisher", printable_name(scan.topic.publisher)},
                                   {"messages", scan.messages},
                                   {"rate_hz", scan.rate_hz()},
                                   {"bytes", scan.bytes},
                                   {"longest_gap_s", to_seconds(scan.longest_gap)}});
      }
    }
    root["files"].push_back(std::move(entry));
  }
  return file_text(root);
}

}  // namespace simbench::reports
