// A scenario: one world to synchronise and the pipelines to try in it, as plain data.
//
// This is the loaded form of a scenario file (scenarios/*.json), after inheritance ("base"), --set
// overrides, schema validation and semantic checks; load it with scenarios/loader.h. Every member
// has the name, the unit and the meaning of its JSON key; scenarios/schema.json documents each with
// its allowed range and its source. There are no defaults (the zeros below never reach a loaded
// scenario): a scenario inherits or states every member, so that `simbench describe` prints every
// number behind a result. The exceptions are the schema's "x-optional" members, whose effect is off
// until they are stated. Members whose values are words are enums (scenarios/choices.h).
//
// Conventions: *_sigma is a standard deviation of a zero-mean normal; *_exponential_ms the mean of
// an exponential; *_log_sigma the sigma of exp(N(0, sigma)), a factor of median 1; a probability is
// per message, per frame or per pulse. "Run load" M = exp(N(load_log_sigma)) is drawn once per
// (seed, pipeline, scenario).
//
// Sources: docs/reference/calibration.md (sections 1 and 2), docs/reference/d455.md, docs/design.md
// section 7.
#ifndef SIMBENCH_SCENARIOS_SCENARIO_H_
#define SIMBENCH_SCENARIOS_SCENARIO_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenarios/choices.h"
#include "scenarios/derivation.h"
#include "scenarios/lazy.h"
#include "scenarios/published_figure.h"

namespace simbench::scenarios {

struct Timeline {
  double wait_before_capture_ms = 0;  // from the end of host synchronisation to the capture
  double warm_up_ms = 0;              // discarded start of the capture
  std::int64_t frames = 0;            // trigger pulses evaluated after the warm-up
};

// A free-running oscillator. Its frequency error is skew + white noise + flicker + random walk +
// ramp + self-heating + temperature.
struct Oscillator {
  std::string class_name{};   // "class": the profile it has (scenarios/oscillator_class.h; else "")
  double skew_sigma_ppm = 0;  // one draw per oscillator and seed
  double white_frequency_ppb = 0;         // Allan deviation of the white part at tau = 1 s
  double random_walk_ppb_per_sqrt_s = 0;  // random walk: Allan deviation = this * sqrt(tau / 3)
  double wander_step_ms = 0;              // fixed grid on which the noise is sampled
  double flicker_floor_ppb = 0;           // flicker: Allan deviation from 0.1 s to 1000 s
  double ramp_ppm_per_hour = 0;           // from true zero
  double self_heating_ppm = 0;            // approached exponentially after switching on
  double self_heating_time_constant_s = 0;
  double temperature_coefficient_ppb_per_k = 0;
};

// The temperature of each host about its mean: a sine, a square wave behind a first-order lag and a
// triangle, each with a start phase of its own.
struct Temperature {
  double day_amplitude_k = 0;
  double day_period_h = 0;
  double load_amplitude_k = 0;
  double load_period_s = 0;
  double load_time_constant_s = 0;
  double fan_amplitude_k = 0;
  double fan_period_s = 0;
};

// The frequency that a host's clock service has kept from its last run.
struct DriftFile {
  double age_h = 0;      // since that run ended
  double error_ppb = 0;  // standard deviation, when it was written
};

// A system clock that was set long ago and has run free since (host_sync "ntp_last_set").
struct LastSet {
  double hours_ago = 0;
  double skew_sigma_ppm = 0;          // rate error in those hours, independent of the present one
  double minutes_since_baseline = 0;  // this recording's delay after the one that defines hours_ago
};

struct HostClock {
  Oscillator oscillator;
  double initial_offset_sigma_ms = 0;  // slaves' clocks before synchronisation; the master has 0
  // In place of the draws, the master first (else empty).
  std::vector<double> skew_of_host_ppm{};
  std::vector<double> initial_offset_of_host_ms{};
  double tick_ms = 0;                     // granularity of the system clock itself (0: continuous)
  double resolution_ms = 0;               // get and set round down to this (SYSTEMTIME: 1 ms)
  double read_cost_ms = 0;                // CPU time of a get call
  double set_cost_ms = 0;                 // CPU time of a set call
  double set_cost_session_log_sigma = 0;  // factor per host and (seed, pipeline)
  double set_cost_call_log_sigma = 0;     // factor per call
  double set_effective_fraction = 0;      // of the call's duration until the new value counts
  double arrival_quantum_ms = 0;          // of the stamps that the host gives arriving frames
  LastSet last_set;
};

// Bursts begin as a Poisson process in true time.
struct Burst {
  double rate_hz = 0;  // 0: none
  double duration_exponential_ms = 0;
  // network: extra latency; host: extra delay U(0, twice this); wifi: extra wait Exp(this)
  double latency_ms = 0;
};

// The network card's own clock.
struct Nic {
  bool hardware_stamps = false;
  double skew_sigma_ppm = 0;
  double stamp_resolution_ns = 0;
  double stamp_jitter_sigma_ns = 0;
  double cross_stamp_cost_ms = 0;
};

// How long one part of a message's way takes. Either fixed + Exp, or a table of quantiles; spikes
// come on top. A share of the variance (of the normal score) is common to all that passes this part
// of the host within about common_time_ms.
struct DelayLaw {
  double fixed_us = 0;
  double exponential_us = 0;
  std::vector<double> quantiles_us{};  // in place of fixed_us and exponential_us (else empty)
  double spike_probability = 0;
  double spike_max_us = 0;  // a spike adds U(0, this)
  double common_share = 0;
  double common_time_ms = 0;
};

// The way of a message through a host, between the calls of its program and the network card
// (sim/host/stack.h).
struct Stack {
  DelayLaw transmit;                   // the call, until the software transmit stamp
  DelayLaw transmit_to_card;           // from there until the card sends
  DelayLaw receive;                    // from the interrupt to the software receive stamp
  DelayLaw wake_up;                    // from there until the receiver's call returns
  double interrupt_moderation_us = 0;  // least time between two interrupts
  double interrupts_per_s = 0;         // of other traffic of the host
  double sleep_share = 0;  // of the messages find the processor in an energy-saving sleep
  double sleep_exit_us = 0;
  double awake_us = 0;         // after a message of its own, sent or received
  double sleep_time_ms = 0;    // for how long a host stays awake or sleepy
  double speed_log_sigma = 0;  // factor exp(N(0, this)) on all these delays, one draw per host
};

// Electrical pulses wired into every host.
struct PulseLines {
  bool pps = false;
  bool gnss = false;  // the receiver also sends the time of its pulses
  bool trigger = false;
  double pps_jitter_sigma_us = 0;
  double interrupt_latency_us = 0;
  double interrupt_latency_exponential_us = 0;
};

struct Hosts {
  std::int64_t count = 0;        // host 0 is the master
  bool master_is_exact = false;  // the master's oscillator has no frequency error of any kind
  HostClock clock;
  double send_cost_ms = 0;                      // sender occupancy per message
  double send_cost_exponential_ms = 0;          // additional, per message
  double send_cost_session_exponential_ms = 0;  // additional, per session: Exp(this * M)
  double receive_wake_up_ms = 0;  // from availability of a message to the receiver's return
  double load_log_sigma = 0;      // run load M
  Nic nic;
  PulseLines pulse_lines;
  Burst load_burst;  // frames are delivered and messages noticed later
  std::optional<Temperature> temperature{};
  std::optional<DriftFile> drift_file{};
  std::optional<Stack> stack{};
};

// The link of a host with the master. What it does not state is the network's.
struct Link {
  std::int64_t host = 0;
  std::optional<double> latency_fixed_ms{};
  std::optional<double> latency_exponential_ms{};
  std::optional<double> asymmetry_ms{};  // fixed latency towards the host minus back
};

// A station sleeps after a time without messages of its own, and wakes for beacons.
struct WifiPowerSave {
  double idle_ms = 0;             // after its last message, until it sleeps
  double beacon_interval_ms = 0;  // of the access point
  std::int64_t dtim_period = 0;   // beacons from one for which it wakes to the next
  double wake_up_ms = 0;          // before a sleeping station sends
};

// One wireless cell in which every host is a station, but for the access point and those on its
// wire (sim/network/wifi.h: the model, its assumptions and sources).
struct Wifi {
  std::optional<std::int64_t> access_point_host{};  // none: a device of its own
  std::vector<std::int64_t> wired_hosts{};          // on the access point's switch
  double rate_mbit_per_s = 0;
  double basic_rate_mbit_per_s = 0;  // of acknowledgements, broadcasts and multicasts
  double preamble_us = 0;
  double sifs_us = 0;
  double slot_us = 0;  // DIFS is SIFS and two of these
  std::int64_t contention_window_min = 0;
  std::int64_t contention_window_max = 0;
  std::int64_t retry_limit = 0;  // attempts at a transmission
  double collision_probability = 0;
  Burst busy;  // foreign traffic on the channel
  std::optional<WifiPowerSave> power_save{};
};

struct Network {
  double latency_fixed_ms = 0;
  double latency_exponential_ms = 0;
  double latency_session_exponential_ms = 0;  // per session: Exp(this * M)
  double asymmetry_sigma_ms = 0;              // per link: forward minus backward fixed latency
  double port_asymmetry_sigma_ms = 0;         // per host: its port of the switch adds to all links
  double spike_probability = 0;
  double spike_max_ms = 0;  // a spike adds U(0, this)
  // In place of fixed, exponential and spike: the latency at equally spaced probabilities 0 to 1.
  std::vector<double> latency_quantiles_ms{};
  Burst burst;
  double bandwidth_mbit_per_s = 0;   // of each switch port, queueing in order (0: infinite)
  double overhead_bytes = 0;         // headers per message
  double loss_probability = 0;       // per message; a stream retransmits after the timeout
  double duplicate_probability = 0;  // datagrams only
  double reorder_probability = 0;    // datagrams only: delayed by U(0, reorder_max_ms)
  double reorder_max_ms = 0;
  double retransmit_timeout_ms = 0;
  bool nagle = false;         // streams: a small segment waits for the previous one's ACK
  double delayed_ack_ms = 0;  // streams: ACK of a single segment waits this long (0: at once)
  StampPoint stamp_point{};   // where receive stamps are taken
  double capture_traffic_share = 0;  // of each frame's bytes, sent on through the host's port
  SwitchClockKind switch_clock{};    // PTP
  double switch_clock_error_ns = 0;
  std::vector<Link> links{};
  // The switches stand in a line, each wired to the next; the number of each host's (else empty:
  // one switch for all).
  std::vector<std::int64_t> switch_of_host{};
  double switch_residence_ms = 0;  // fixed, in each switch on the way
  double cross_traffic_share = 0;  // of each switch port's time, by full frames of others
  double switch_clock_wander_ppb_per_sqrt_s = 0;  // random walk of a boundary switch's oscillator
  std::optional<Wifi> wifi{};                     // none: all hosts are wired
};

struct TriggerPause {
  double at_ms = 0;  // after the start of the capture
  double duration_ms = 0;
};

struct Trigger {
  double rate_hz = 0;
  double rate_error_ppm = 0;  // advised +500 for slaves
  double pulse_jitter_sigma_us = 0;
  double branch_delay_max_us = 0;  // per sub-trigger: U(0, this)
  double cable_delay_max_us = 0;   // per camera: U(0, this)
  std::int64_t cameras_per_sub_trigger = 0;
  double start_delay_ms = 0;        // first pulse after the cameras have started
  double daisy_chain_delay_us = 0;  // from camera to camera (0: a star)
  double missed_pulse_probability = 0;
  std::vector<TriggerPause> pauses;

  double period_ms() const { return 1e3 / rate_hz; }
  // The rate of the pulses, with the trigger's own rate error.
  double pulse_rate_hz() const { return rate_hz * (1 + rate_error_ppm * 1e-6); }
};

// The mode in which a delay was measured: it holds for no other.
struct StreamMode {
  std::int64_t width = 0;
  std::int64_t height = 0;
  double mode_rate_hz = 0;
};

// One image stream of a camera.
struct Stream {
  StreamKind kind{};
  std::int64_t width = 0;
  std::int64_t height = 0;
  double bytes_per_pixel = 0;
  double mode_rate_hz = 0;          // of the profile; genlock delivers at most half of it
  double pipeline_latency_ms = 0;   // fixed, from end of exposure to the start of the transfer
  double latency_mode_periods = 0;  // plus this many mode periods
  ShutterKind shutter{};
  double readout_ms = 0;  // rolling: from the first row's exposure to the last row's
  // End of exposure to arrival, as a user measured it once for this model, and where. Neither: as
  // one would measure it in this world (scenarios/calibration.h).
  std::optional<double> calibrated_delay_ms{};
  std::optional<StreamMode> calibrated_at{};

  double image_bytes() const { return static_cast<double>(width * height) * bytes_per_pixel; }
};

// The delays of the polls whose asymmetry was measured: it holds for no others.
struct PollDelays {
  double request_ms = 0;
  double reply_ms = 0;
};

// Readings of a camera's clock over its control interface.
struct ClockPoll {
  double interval_ms = 0;  // 0: none
  double request_ms = 0;   // from the host's first reading to the camera's
  double request_exponential_ms = 0;
  double reply_ms = 0;  // from the camera's reading to the host's second
  double reply_exponential_ms = 0;
  double tail_probability = 0;  // that a request takes U(0, tail_max_ms) longer
  double tail_max_ms = 0;
  // Request minus reply, as a user measured it once, and of which polls. Neither: that of these.
  std::optional<double> calibrated_asymmetry_ms{};
  std::optional<PollDelays> calibrated_at{};

  bool is_on() const { return interval_ms > 0; }
};

struct AutoExposure {
  double step_interval_exponential_ms = 0;  // 0: the exposure does not change
  double min_ms = 0;                        // a step goes to U(min_ms, max_ms)
  double max_ms = 0;

  bool is_on() const { return step_interval_exponential_ms > 0; }
};

// By how much this rig's delays differ from what was measured for the model, one draw each per seed
// and per camera and seed. The rig differs, not what the user knows.
struct CalibrationError {
  double delay_error_sigma_ms = 0;           // end of exposure to arrival, of all cameras
  double camera_delay_error_sigma_ms = 0;    // the same, of each camera
  double poll_asymmetry_error_sigma_ms = 0;  // request minus reply, of all cameras

  bool operator==(const CalibrationError&) const = default;
};

// What a program may change about the frames of each camera (algorithms/ports/frame_control.h), and
// how well the camera obeys (sim/camera/steered_sensor.h).
struct FrameControlModel {
  bool adjust_frame = false;  // the controls that the cameras have
  bool insert_frame = false;
  bool frame_length = false;
  bool start_at = false;
  double granularity_us = 0;  // of the lengths of frames
  double shortest_ms = 0;
  double longest_ms = 0;
  std::int64_t latency_frames = 0;
  double delay_ms = 0;  // of a control, until the camera has it
  double delay_exponential_ms = 0;
  double loss_probability = 0;        // per control
  std::int64_t insert_stretches = 1;  // an inserted frame has its length so many times
  double insert_noise_sigma_us = 0;   // of the length of an inserted frame
  double start_jitter_sigma_us = 0;   // of a start at a time
  double frame_jitter_sigma_us = 0;   // of each exposure, which the next frames do not inherit
  ClockOwner sensor_clock{};          // whose oscillator counts the lengths
};

// A ring of 100 LEDs of which one is lit at a time, and a counter of its turns, in view of all
// cameras (sim/rig/led_clock.h: which images show the time, and what is left out).
struct LedClockModel {
  double interval_ms = 0;  // of each camera, an image is looked at once in so long (0: all)
  // In view for so long from the start of the capture and before its end (both 0: always).
  double first_ms = 0;
  double last_ms = 0;
  double step_ms = 0;             // each LED is lit for
  double missed_probability = 0;  // per image that is looked at: nothing is read
  double wrong_probability = 0;   // per image that is read: the turn is counted wrong by one
  double skew_sigma_ppm = 0;      // of its own oscillator: one draw per seed
  double row_spread_share = 0;    // of a rolling readout: the board's row, one draw per camera
};

struct Cameras {
  std::int64_t count = 0;
  std::int64_t cameras_per_host = 0;         // camera j is on host j / cameras_per_host, unless
  std::vector<std::int64_t> host_of_camera;  // this names a host for each camera (else empty)
  std::vector<double> skew_of_camera_ppm{};  // in place of the drawn skew (else empty)
  std::string model;                         // a profile of scenarios/cameras
  SyncMode sync_mode{};                      // how the cameras respond to a pulse
  // genlock: trigger off, start all, trigger on; else the cameras start one by one
  bool common_start = false;
  double start_spread_ms = 0;  // without a common start: each camera starts after U(0, this)
  std::vector<Stream> streams;
  Oscillator oscillator;
  double clock_epoch_max_ms = 0;     // device clock at the start: U(0, this)
  double latency_camera_max_ms = 0;  // plus U(0, this), fixed per camera
  double exposure_ms = 0;
  double exposure_camera_periods = 0;  // plus this * trigger period * U(0,1) per camera
  double exposure_host_periods = 0;    // plus this * trigger period * U(0,1) per host
  double trigger_to_exposure_us = 0;
  double genlock_guard_fraction = 0;  // pulses are ignored for two mode periods less this share
  double slave_free_run_after_periods = 0;  // a slave without pulses waits so many periods
  double sensor_stamp_jitter_sigma_us = 0;  // of the device's stamps, before quantisation to 1 us
  double drop_probability = 0;              // frame lost inside the camera
  double unstable_start_ms = 0;             // exposures are unsteady after the start of the camera
  double unstable_start_jitter_sigma_ms = 0;
  ClockPoll clock_poll;
  AutoExposure auto_exposure;
  CalibrationError calibration{};
  std::optional<FrameControlModel> frame_control{};
  std::optional<LedClockModel> led_clock{};
  ClockOwner stamp_clock{};  // of the sensor and frame stamps

  // Null if the cameras do not have that stream.
  const Stream* stream(StreamKind kind) const;
  // Whether the sync mode lets the trigger decide when the stream exposes, by the model's profile.
  // Throws std::invalid_argument if there is no such model, which a loaded scenario cannot have.
  bool follows_trigger(const Stream& stream) const;
};

// What librealsense makes of the kernel's stamp of a frame (sim/usb/backend_stamp.h).
struct BackendStamp {
  double host_uptime_h = 0;  // Windows: at the start of the capture; 0: no rounding to a float
  double resolution_ms = 0;  // of the SDK's clocks and stamps (0: exact)
};

struct Usb {
  double bandwidth_mb_per_s = 0;  // of a controller (of a camera when dedicated)
  UsbSharing sharing{};
  std::int64_t cameras_per_controller = 0;
  std::int64_t buffered_frames = 0;       // pending transfers per stream; beyond: frame dropped
  double kernel_copy_exponential_ms = 0;  // between end of transfer and the back-end stamp
  double delivery_jitter_transfers = 0;   // Exp(this * transfer time), independent per frame
  double host_jitter_transfers = 0;       // the same, common to the cameras of a host, AR(1) with
  double host_jitter_correlation = 0;     //   this coefficient from frame to frame
  double spike_probability = 0;           // rare big jumps
  double spike_max_transfers = 0;         // of U(0, this * transfer time)
  // In place of kernel copy, delivery jitter and spikes: the delay after the end of the transfer at
  // equally spaced probabilities 0 to 1.
  std::vector<double> delivery_quantiles_ms{};
  double delivery_correlation = 0;  // from frame to frame (Gaussian copula); 0 without the table
  std::optional<BackendStamp> backend_stamp{};  // else in steps of the arrivals'
};

// Faults during the capture, one type for each kind. Times count from the start of the capture; a
// duration lasts until the camera, host or link returns.
struct CameraVanishes {
  static constexpr std::string_view kKind = "camera_vanishes";
  std::int64_t camera = 0;
  double at_ms = 0;
  double duration_ms = 0;
};
struct LateFirstFrame {
  static constexpr std::string_view kKind = "late_first_frame";
  std::int64_t camera = 0;
  double duration_ms = 0;  // how late its first frame arrives
};
struct ClockStep {
  static constexpr std::string_view kKind = "clock_step";
  std::int64_t host = 0;
  double at_ms = 0;
  double step_ms = 0;
};
struct HostStops {
  static constexpr std::string_view kKind = "host_stops";
  std::int64_t host = 0;
  double at_ms = 0;
  double duration_ms = 0;
};
struct LinkStops {
  static constexpr std::string_view kKind = "link_stops";
  std::int64_t host = 0;
  double at_ms = 0;
  double duration_ms = 0;
};
// Every host's clock takes it when it reads the instant itself.
struct LeapSecond {
  static constexpr std::string_view kKind = "leap_second";
  double at_ms = 0;
  double smear_ms = 0;    // spread evenly over this (0: a step)
  bool inserted = false;  // the clock goes back by a second; else it skips one
};
using Fault =
    std::variant<CameraVanishes, LateFirstFrame, ClockStep, HostStops, LinkStops, LeapSecond>;

// Real programs that synchronise the hosts' clocks (sim/programs/program_sync.h).
struct HostPrograms {
  using Command = std::vector<std::string>;  // the program and its arguments
  std::vector<Command> master;
  std::vector<Command> slave;
  std::map<std::string, std::string> files{};  // contents by name, in each host's folder
  std::map<std::string, std::string> environment{};
  double run_before_capture_s = 0;
  bool run_during_capture = true;
  std::string model{};  // the pipeline whose algorithm models them; empty: none

  bool operator==(const HostPrograms&) const = default;
};

// The last part of the path: "chronyd".
std::string program_name(const HostPrograms::Command& command);

// One choice for each stage, by the names under which algorithms are registered. Programs take the
// place of an algorithm; host_sync is then "program" and the name of the slaves' first one.
struct Pipeline {
  std::string name;
  std::string host_sync;
  std::string device_time;
  std::string gathering;
  std::optional<HostPrograms> programs{};
  std::string capture_alignment{};  // empty: none
};

// A parameter of an algorithm, which the algorithm's registration checks.
using ParameterValue = std::variant<bool, double, std::string>;
// Parameters by algorithm (its name or its family's), then by parameter name.
using AlgorithmParameters = std::map<std::string, std::map<std::string, ParameterValue>>;

struct Evaluation {
  StreamKind stream{};  // which stream is scored
  TableKind table{};
  double gathering_interval_periods = 0;  // T_int as a share of the frame period
  MedianKind rmdv_median{};
};

// A published result for comparison with a pipeline's row.
struct Published {
  double amd_ms = 0;
  double rmdv_ms = 0;
};

// The subject in a studio and its motion (reconstruction/motion.h).
struct StudioSubject {
  SubjectKind kind{};
  std::string mesh_file;  // mesh: PLY, OBJ, OFF or STL; of a person ""
  double height_m = 0;    // of a person
  MotionScript motion{};
  double walk_speed_m_per_s = 0;
  double turn_rate_rad_per_s = 0;
  double arm_rate_rad_per_s = 0;
};

// A published reconstruction for comparison with a pipeline's row.
struct PublishedReprojection {
  double mean_cm = 0;
  double std_cm = 0;
};

// The scene of the cameras' depth streams, for `simbench reconstruct`.
struct Studio {
  double radius_m = 0;          // of the circle on which the cameras stand
  double azimuth_step_deg = 0;  // camera j has the azimuth j / heights, the height j % heights
  std::vector<double> heights_m;
  double look_at_height_m = 0;
  bool portrait = false;                        // cameras are rolled by 90 degrees
  double calibration_translation_sigma_mm = 0;  // of the extrinsics, per axis
  double calibration_rotation_sigma_deg = 0;    // likewise
  double stereo_baseline_mm = 0;
  double subpixel_error_px = 0;  // standard deviation of the disparity
  double missing_share = 0;      // of the pixels on the subject, at random
  double max_incidence_deg = 0;  // steeper surfaces give no depth
  double min_distance_m = 0;
  double max_distance_m = 0;
  double point_spacing_mm = 0;            // fused points are averaged on a grid of this
  double visibility_tolerance_mm = 0;     // of the z-buffer test
  std::int64_t visibility_spread_px = 0;  // each of its pixels is spread so far around it
  StudioSubject subject;
  std::map<std::string, PublishedReprojection> published;  // by pipeline name
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
  std::vector<PublishedFigure> published_figures;
  std::optional<Studio> studio;     // only of scenarios that have one
  Derivation derivation;            // from a built-in scenario
  Lazy<std::string> resolved_json;  // fully resolved, pretty-printed
  std::shared_ptr<const Origin> origin;

  // The host that camera j is plugged into.
  std::int64_t host_of(std::int64_t camera) const {
    return cameras.host_of_camera.empty()
               ? camera / cameras.cameras_per_host
               : cameras.host_of_camera[static_cast<std::size_t>(camera)];
  }
  // How many cameras each host has.
  std::vector<std::size_t> cameras_by_host() const;
  // Whether each pipeline draws a load of its own, which its sends, messages and settings of clocks
  // meet (sim/network/load.h).
  bool draws_load() const {
    return hosts.send_cost_session_exponential_ms > 0 ||
           network.latency_session_exponential_ms > 0 || hosts.clock.set_cost_session_log_sigma > 0;
  }
  // The scored stream; a loaded scenario has it.
  const Stream* scored_stream() const { return cameras.stream(evaluation.stream); }
  // The rate at which a stream delivers frames if none is lost.
  double frame_rate_hz(const Stream& stream) const {
    return cameras.follows_trigger(stream) ? trigger.pulse_rate_hz() : stream.mode_rate_hz;
  }
};

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_SCENARIO_H_
