#include "tests/algorithms/capture_alignment/fake_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

namespace asio = boost::asio;

constexpr Nanoseconds kDeviceLead = from_ms(123'456.789);  // of the cameras' own clocks

}  // namespace

FakeCamera::FakeCamera(ScriptWorld& world, ScriptHost& host, std::uint32_t number,
                       FakeCameraScript script)
    : world_(world),
      host_(host),
      number_(number),
      script_(std::move(script)),
      steady_length_(script_.limits.nearest(script_.limits.frame_length)) {
  lengths_[0] = steady_length_;
  schedule(script_.phase);
}

void FakeCamera::schedule(Nanoseconds middle) {
  const std::uint64_t number = ++schedule_;
  if (middle >= script_.stops_at) return;
  const Nanoseconds half = script_.limits.exposure / 2;
  world_.call_at(middle + half, [this, middle, number] {
    if (number != schedule_) return;
    middles_.push_back(middle);
    expose();
  });
}

Nanoseconds FakeCamera::length_after(std::int64_t frame) const {
  const auto single = single_.find(frame);
  if (single != single_.end()) return single->second;
  return std::prev(lengths_.upper_bound(frame))->second;
}

// The readout of the newest frame begins.
void FakeCamera::expose() {
  ++frame_;
  const Nanoseconds middle = middles_.back();
  const auto counter = static_cast<std::uint32_t>(frame_);
  world_.call_at(world_.now() + script_.delay,
                 [this, middle, counter] { deliver(middle, counter); });
  schedule(middle + from_ns(to_ns(length_after(frame_)) * (1 + script_.rate_ppm * 1e-6)));
}

void FakeCamera::deliver(Nanoseconds middle, std::uint32_t counter) {
  FrameArrival frame;
  frame.camera = number_;
  frame.counter = counter;
  frame.sensor.us = static_cast<std::uint32_t>((middle + kDeviceLead).count() / 1000);
  frame.arrival = host_.reading();
  frame.arrival_steady = SteadyTime(world_.now());
  if (script_.stamps_steady) frame.sensor_steady = SteadyTime(middle);
  delivered_.push_back(frame);
  if (waiting_) waiting_->cancel();
}

Task<std::optional<FrameArrival>> FakeCamera::next_frame(SteadyTime deadline) {
  if (delivered_.empty()) {
    if (waiting_) throw std::logic_error("a wait for a frame is already pending on this camera");
    const auto gate = std::make_shared<asio::steady_timer>(world_.context(),
                                                           asio::steady_timer::time_point::max());
    waiting_ = gate;
    world_.call_at(deadline.time_since_epoch(), [gate] { gate->cancel(); });
    boost::system::error_code opened;
    co_await gate->async_wait(asio::redirect_error(asio::use_awaitable, opened));
    waiting_.reset();
  }
  if (delivered_.empty()) co_return std::nullopt;
  const FrameArrival frame = delivered_.front();
  delivered_.pop_front();
  co_return frame;
}

FrameControlReply FakeCamera::send(FrameControlKind kind, Nanoseconds value, Nanoseconds length) {
  std::string refused = refusal_of(script_.limits, kind, length);
  if (!refused.empty()) return {.refused = std::move(refused)};
  controls_.push_back({kind, value, world_.now()});
  const Nanoseconds made = script_.limits.nearest(length);
  if (script_.is_lost(sent_++)) return {.length = made};
  const std::int64_t frame = frame_ + std::max<std::int64_t>(script_.limits.latency_frames, 1);
  if (kind == FrameControlKind::kFrameLength) {
    lengths_[frame] = made;
    steady_length_ = made;
  } else if (kind == FrameControlKind::kAdjustFrame) {
    single_[frame] = made;
  } else {
    for (int more = 0; more < script_.stretched_per_insert; ++more) single_[frame + more] = made;
  }
  return {.length = made};
}

Task<FrameControlReply> FakeCamera::change(FrameControlKind kind, Nanoseconds length) {
  const bool is_relative = kind == FrameControlKind::kAdjustFrame;
  co_return send(kind, length, is_relative ? steady_length_ + length : length);
}

Task<FrameControlReply> FakeCamera::start_at(HostTime at) {
  const auto kind = FrameControlKind::kStartAt;
  std::string refused = refusal_of(script_.limits, kind, {});
  if (refused.empty() && at <= host_.reading()) refused = "a start in the past";
  if (!refused.empty()) co_return FrameControlReply{.refused = std::move(refused)};
  const Nanoseconds begin = world_.now() + (at - host_.reading());
  controls_.push_back({kind, at.time_since_epoch(), world_.now()});
  const bool is_lost = script_.is_lost(sent_++);
  co_await world_.wait_until(begin);
  if (!is_lost) schedule(begin + script_.limits.exposure / 2);
  co_return FrameControlReply{};
}

AlignmentReport FakeHost::last_report(std::uint32_t camera) const {
  const auto newest =
      std::find_if(reports_.rbegin(), reports_.rend(),
                   [camera](const AlignmentReport& report) { return report.camera == camera; });
  if (newest != reports_.rend()) return *newest;
  ADD_FAILURE() << "camera " << camera << " was not reported";
  return {};
}

FakeRig::FakeRig(PeerId hosts) : world_(hosts) {
  hosts_.reserve(hosts);
  for (PeerId id = 0; id < hosts; ++id)
    hosts_.push_back(std::make_unique<FakeHost>(world_.host(id)));
  world_.connect(from_ms(1));
}

FakeCamera& FakeRig::add(PeerId host_id, FakeCameraScript script) {
  const auto number = static_cast<std::uint32_t>(cameras_.size());
  cameras_.push_back(std::make_unique<FakeCamera>(world_, world_.host(host_id), number, script));
  host(host_id).add(*cameras_.back());
  return *cameras_.back();
}

void FakeRig::run(CaptureAlignment& algorithm, Nanoseconds end) {
  for (const PeerId slave : world_.slaves()) world_.start(algorithm.run_slave(host(slave), 0));
  world_.start(algorithm.run_master(host(0), world_.slaves()));
  world_.call_at(end, [] {});
  world_.run(end);
}

std::unique_ptr<CaptureAlignment> make_alignment(const std::string& name,
                                                 const ParameterValues& given) {
  const CaptureAlignmentEntry* const entry = find_algorithm<CaptureAlignmentEntry>(name);
  if (entry == nullptr) throw std::out_of_range(name);
  return entry->make(check_parameters(entry->info.parameters, given));
}

}  // namespace simbench
