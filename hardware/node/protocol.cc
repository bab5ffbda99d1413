#include "hardware/node/protocol.h"

#include <algorithm>
#include <utility>

namespace simbench::hardware {
namespace {

using nlohmann::json;

Bytes bytes_of(const json& message) {
  const std::string text = message.dump(-1, ' ', false, json::error_handler_t::replace);
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

json parse_object(std::span<const std::byte> message) {
  const auto* begin = reinterpret_cast<const char*>(message.data());
  json parsed = json::parse(begin, begin + message.size(), nullptr, false);
  if (!parsed.is_object()) throw ProtocolError("a message that is no JSON object");
  return parsed;
}

std::uint64_t take_id(json& message) {
  const auto found = message.find("id");
  if (found == message.end() || !found->is_number_unsigned()) {
    throw ProtocolError("a message without an id");
  }
  const auto id = found->get<std::uint64_t>();
  message.erase(found);
  return id;
}

// Throws if the member is missing or no text.
std::string take_text(json& message, const char* key) {
  const auto found = message.find(key);
  if (found == message.end() || !found->is_string()) {
    throw ProtocolError(std::string("a message whose '") + key + "' is no text");
  }
  std::string text = found->get<std::string>();
  message.erase(found);
  return text;
}

}  // namespace

Bytes encode(const NodeRequest& request) {
  json message = request.arguments.is_object() ? request.arguments : json::object();
  message["id"] = request.id;
  message["do"] = request.verb;
  return bytes_of(message);
}

Bytes encode(const NodeAnswer& answer) {
  if (!answer.notice.empty()) {
    json message = answer.details.is_object() ? answer.details : json::object();
    message["notice"] = answer.notice;
    return bytes_of(message);
  }
  if (!answer.error.empty()) return bytes_of({{"id", answer.id}, {"error", answer.error}});
  return bytes_of({{"id", answer.id},
                   {"result", answer.details.is_object() ? answer.details : json::object()}});
}

NodeRequest parse_request(std::span<const std::byte> message) {
  json parsed = parse_object(message);
  NodeRequest request;
  request.id = take_id(parsed);
  request.verb = take_text(parsed, "do");
  request.arguments = std::move(parsed);
  return request;
}

NodeAnswer parse_answer(std::span<const std::byte> message) {
  json parsed = parse_object(message);
  NodeAnswer answer;
  if (parsed.contains("notice")) {
    answer.notice = take_text(parsed, "notice");
    if (answer.notice.empty()) throw ProtocolError("a notice of nothing");
    answer.details = std::move(parsed);
    return answer;
  }
  answer.id = take_id(parsed);
  if (parsed.contains("error")) {
    answer.error = take_text(parsed, "error");
    if (answer.error.empty()) throw ProtocolError("a reply with an empty error");
    return answer;
  }
  const auto result = parsed.find("result");
  if (result == parsed.end() || !result->is_object()) {
    throw ProtocolError("a reply without a result");
  }
  answer.details = std::move(*result);
  return answer;
}

bool is_session_id(const std::string& text) {
  return text.size() == 16 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace simbench::hardware
