// simbench with one more algorithm for the stage device_time: constant_delay.
//
//   my_bench list                            shows it among simbench's own
//   my_bench --scenario my_rig.json          prints its row
#include <memory>

#include "algorithms/registry.h"
#include "cli/command_line.h"

namespace {

// A frame was exposed a fixed time before it arrived: no more than that.
class ConstantDelay : public simbench::DeviceTimeEstimator {
 public:
  explicit ConstantDelay(double delay_ms) : delay_(simbench::from_ms(delay_ms)) {}
  simbench::GlobalTime stamp(const simbench::DeviceSample& sample) override {
    return simbench::GlobalTime(sample.arrival.time_since_epoch() - delay_);
  }

 private:
  simbench::Nanoseconds delay_;
};

}  // namespace

int main(int argc, char** argv) {
  simbench::register_device_time({
      .info = {.name = "constant_delay",
               .family = "constant_delay",
               .summary = "arrival minus a constant",
               .source = "an example",
               .parameters = {{.name = "delay_ms",
                               .fallback = 40.0,
                               .low = 0,
                               .high = 1000,
                               .choices = {},
                               .meaning = "from exposure to arrival",
                               .source = "a guess"}}},
      .make =
          [](const simbench::Parameters& parameters) {
            return std::make_unique<ConstantDelay>(parameters.number("delay_ms"));
          },
  });
  return simbench::run_command_line(argc, argv);
}
