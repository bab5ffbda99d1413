// A scenario: one world to synchronise and the pipelines to try in it, as plain data.
//
// This is the loaded form of a scenario file (scenarios/*.json), after inheritance ("base"), --set
// overrides, schema validation and semantic checks; load it with scenarios/loader.h. Every member
// has the name, the unit and the meaning of its JSON key; scenarios/schema.json documents each with
// its allowed range and its source. There are no defaults here: what a scenario does not inherit it
// must state, so that `simbench describe` prints every number a result rests on.
//
// Conventions: *_sigma is a standard deviation of a zero-mean normal; *_exponential_ms the mean of
// an exponential; *_log_sigma the sigma of exp(N(0, sigma)), a factor of median 1; a probability is
// per message, per frame or per pulse. "Run load" M = exp(N(load_log_sigma)) is drawn once per
// (seed, pipeline, scenario).
//
// Sources: reference/calibration.md (sections 1 and 2), reference/d455.md, DESIGN section 7.
#ifndef SIMBENCH_SCENARIOS_SCENARIO_H_
#define SIMBENCH_SCENARIOS_SCENARIO_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace simbench::scenarios {

struct Timeline {
  double wait_before_capture_ms;  // pause between the end of host synchronisation and the capture
  double warm_up_ms;              // discarded start of the capture
  std::int64_t frames;            // trigger pulses evaluated after the warm-up
};

// A free-running oscillator. Its frequency error is skew + white noise + random walk.
struct Oscillator {
  double skew_sigma_ppm;              // one draw per oscillator and seed
  double white_frequency_ppb;         // Allan deviation of the white part at tau = 1 s
  double random_walk_ppb_per_sqrt_s;  // random walk: Allan deviation = this * sqrt(tau / 3)
  double wander_step_ms;              // fixed grid on which the noise is sampled
};

// A system clock that was set long ago and has run free since (host_sync "ntp_last_set").
struct LastSet {
  double hours_ago;
  double skew_sigma_ppm;          // rate error in those hours, independent of the present one
  double minutes_since_baseline;  // this recording's delay after the one that defines hours_ago
};

struct HostClock {
  Oscillator oscillator;
  double initial_offset_sigma_ms;     // slaves' clocks before synchronisation; the master has 0
  double tick_ms;                     // granularity of the system clock itself (0: continuous)
  double resolution_ms;               // get and set round down to this (SYSTEMTIME: 1 ms)
  double read_cost_ms;                // CPU time of a get call
  double set_cost_ms;                 // CPU time of a set call
  double set_cost_session_log_sigma;  // factor per host and (seed, pipeline)
  double set_cost_call_log_sigma;     // factor per call
  double set_effective_fraction;      // of the call's duration after which the new value counts
  double arrival_quantum_ms;          // of the stamps that the host gives arriving frames
  LastSet last_set;
};

struct Hosts {
  std::int64_t count;  // host 0 is the master
  HostClock clock;
  double send_cost_ms;                      // sender occupancy per message
  double send_cost_exponential_ms;          // additional, per message
  double send_cost_session_exponential_ms;  // additional, per session: Exp(this * M)
  double receive_wake_up_ms;  // from availability of a message to the receiver's return
  double load_log_sigma;      // run load M
};

struct Burst {
  double rate_hz;  // bursts begin as a Poisson process in true time (0: none)
  double duration_exponential_ms;
  double latency_ms;  // extra latency of messages sent during a burst
};

struct Network {
  double latency_fixed_ms;
  double latency_exponential_ms;
  double latency_session_exponential_ms;  // per session: Exp(this * M)
  double asymmetry_sigma_ms;              // per link: forward minus backward fixed latency
  double spike_probability;
  double spike_max_ms;  // a spike adds U(0, this)
  Burst burst;
  double bandwidth_mbit_per_s;   // of each switch port; queueing in order of arrival (0: infinite)
  double overhead_bytes;         // headers per message
  double loss_probability;       // per message; a stream retransmits after the timeout
  double duplicate_probability;  // datagrams only
  double reorder_probability;    // datagrams only: delayed by U(0, reorder_max_ms)
  double reorder_max_ms;
  double retransmit_timeout_ms;
  bool nagle;               // streams: a small segment waits for the previous one's ACK
  double delayed_ack_ms;    // streams: ACK of a single segment waits this long (0: at once)
  std::string stamp_point;  // "application" or "kernel": where receive stamps are taken
};

struct TriggerPause {
  double at_ms;  // after the start of the capture
  double duration_ms;
};

struct Trigger {
  double rate_hz;
  double rate_error_ppm;  // advised +500 for slaves
  double pulse_jitter_sigma_us;
  double branch_delay_max_us;  // per sub-trigger: U(0, this)
  double cable_delay_max_us;   // per camera: U(0, this)
  std::int64_t cameras_per_sub_trigger;
  double start_delay_ms;  // first pulse after the cameras have started
  double missed_pulse_probability;
  std::vector<TriggerPause> pauses;
};

// One image stream of a camera.
struct Stream {
  std::string kind;  // "depth" or "colour"
  std::int64_t width;
  std::int64_t height;
  double bytes_per_pixel;
  double mode_rate_hz;          // of the profile; genlock delivers at most half of it
  double pipeline_latency_ms;   // fixed, from end of exposure to the start of the transfer
  double latency_mode_periods;  // plus this many mode periods
};

struct Cameras {
  std::int64_t count;
  std::int64_t cameras_per_host;             // camera j is on host j / cameras_per_host, unless
  std::vector<std::int64_t> host_of_camera;  // this names a host for each camera (else empty)
  std::string sync_mode;   // "default", "master", "slave", "full_slave", "genlock"
  bool common_start;       // genlock: trigger off, start all, trigger on; else started one by one
  double start_spread_ms;  // without a common start: each camera starts after U(0, this)
  std::vector<Stream> streams;
  Oscillator oscillator;
  double clock_epoch_max_ms;  // device clock at the start: U(0, this)
  double exposure_ms;
  double exposure_camera_periods;  // plus this * trigger period * U(0,1) per camera
  double exposure_host_periods;    // plus this * trigger period * U(0,1) per host
  double trigger_to_exposure_us;
  double genlock_guard_fraction;        // pulses are ignored for two mode periods less this share
  double slave_free_run_after_periods;  // a slave without pulses runs free after so many periods
  double sensor_stamp_jitter_sigma_us;  // of the device's stamps, before quantisation to 1 us
  double drop_probability;              // frame lost inside the camera
  double unstable_start_ms;             // exposures are unsteady after the start of the camera
  double unstable_start_jitter_sigma_ms;
};

struct Usb {
  double bandwidth_mb_per_s;  // of a controller (of a camera when dedicated)
  std::string sharing;        // "dedicated", "fair" or "fifo"
  std::int64_t cameras_per_controller;
  std::int64_t buffered_frames;       // pending transfers per stream; beyond: frame dropped
  double kernel_copy_exponential_ms;  // between end of transfer and the back-end stamp
  double delivery_jitter_transfers;   // Exp(this * transfer time), independent per frame
  double host_jitter_transfers;       // the same, common to the cameras of a host, AR(1) with
  double host_jitter_correlation;     //   this coefficient from frame to frame
  double spike_probability;           // rare big jumps
  double spike_max_transfers;         // of U(0, this * transfer time)
};

// Something that goes wrong, at a time after the start of the capture. Members that the kind does
// not use may not be stated and are 0 here.
struct Fault {
  std::string kind;         // "camera_vanishes", "clock_step", "late_first_frame"
  std::int64_t camera = 0;  // camera_vanishes, late_first_frame
  std::int64_t host = 0;    // clock_step
  double at_ms = 0;         // camera_vanishes, clock_step
  double duration_ms = 0;   // camera_vanishes: until it returns; late_first_frame: its delay
  double step_ms = 0;       // clock_step
};

// One choice for each stage, by the names under which algorithms are registered.
struct Pipeline {
  std::string name;
  std::string host_sync;
  std::string device_time;
  std::string gathering;
};

// A parameter of an algorithm as the scenario states it; the algorithm's registration checks it.
using ParameterValue = std::variant<bool, double, std::string>;
// Parameters by algorithm (its name or its family's), then by parameter name.
using AlgorithmParameters = std::map<std::string, std::map<std::string, ParameterValue>>;

struct Evaluation {
  std::string stream;                 // which stream is scored: "depth" or "colour"
  double gathering_interval_periods;  // T_int as a share of the frame period
  std::string rmdv_median;            // "upper_middle" or "mean_of_middle_two"
};

// A published result that a pipeline's row is put beside.
struct Published {
  double amd_ms;
  double rmdv_ms;
};

// Where each JSON pointer of the scenario came from, for messages (scenarios/loader.h).
class Origin;

struct Scenario {
  std::string name;
  std::string summary;
  Timeline timeline;
  Hosts hosts;
  Network network;
  Trigger trigger;
  Cameras cameras;
  Usb usb;
  std::vector<Fault> faults;
  Evaluation evaluation;
  AlgorithmParameters algorithms;
  std::vector<Pipeline> pipelines;
  std::map<std::string, Published> published;  // by pipeline name
  std::string resolved_json;                   // the fully resolved scenario, pretty-printed
  std::shared_ptr<const Origin> origin;

  // The host that camera j is plugged into.
  std::int64_t host_of(std::int64_t camera) const {
    return cameras.host_of_camera.empty()
               ? camera / cameras.cameras_per_host
               : cameras.host_of_camera[static_cast<std::size_t>(camera)];
  }
};

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_SCENARIO_H_
