#include "sim/host/sim_frame_control.h"

#include <string>
#include <utility>

#include "scenarios/frame_limits.h"
#include "sim/engine/random.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kControl("camera: control of its frames");
constexpr Nanoseconds kBeforeStart = std::chrono::milliseconds(10);

RandomStream control_draws(std::uint64_t run_seed, std::uint32_t camera, std::uint64_t number) {
  return RandomStream(run_seed, kControl, camera, number);
}

}  // namespace

SimFrameControl::SimFrameControl(SimHost& host, std::uint32_t camera,
                                 const scenarios::Scenario& scenario)
    : host_(host),
      camera_(camera),
      model_(*scenario.cameras.frame_control),
      requests_(scenarios::frame_limits(scenario)),
      feed_(host) {}

Task<std::optional<FrameArrival>> SimFrameControl::next_frame(SteadyTime deadline) {
  host_.world().frames.open();
  return feed_.next(deadline);
}

void SimFrameControl::push(FrameArrival frame) {
  frame.reading = std::exchange(reading_, std::nullopt);
  feed_.push(frame);
}

Task<FrameControlReply> SimFrameControl::change(FrameControlKind kind, Nanoseconds length) {
  FrameControlReply reply = requests_.reply(kind, length);
  if (!reply.is_accepted()) co_return reply;
  RandomStream draws = control_draws(host_.world().run_seed, camera_, sent_++);
  const bool is_lost = draws.chance(model_.loss_probability);
  const double delay_ms = model_.delay_ms + draws.exponential(model_.delay_exponential_ms);
  if (!is_lost) {
    const FrameCommand command{.kind = kind, .length = length};
    host_.world().context.engine().call_at(host_.true_now() + from_ms(delay_ms), [this, command] {
      host_.world().frames.steer(camera_, command);
    });
  }
  co_return reply;
}

Task<FrameControlReply> SimFrameControl::start_at(HostTime at) {
  const HostTime now = host_.system_clock().read(host_.true_now());
  std::string refused = refusal_of_start(limits(), at, now);
  if (!refused.empty()) co_return FrameControlReply{.refused = std::move(refused)};
  RandomStream draws = control_draws(host_.world().run_seed, camera_, sent_++);
  const bool is_lost = draws.chance(model_.loss_probability);
  const Nanoseconds late = from_us(draws.normal(model_.start_jitter_sigma_us));
  if (at > now + kBeforeStart) co_await host_.sleep_until(at - kBeforeStart);
  const TrueTime due = host_.system_clock().when(at, host_.true_now());
  if (!is_lost)
    host_.world().frames.steer(camera_, {.kind = FrameControlKind::kStartAt, .at = due + late});
  co_await host_.sleep_until(at);
  co_return FrameControlReply{};
}

}  // namespace simbench::sim
