// The members of the scenario structs under their JSON keys, which are their names.
//
// Reading and writing share one list of names. A test compares these lists with
// scenarios/schema.json and with the structs themselves.
#ifndef SIMBENCH_SCENARIOS_FIELDS_H_
#define SIMBENCH_SCENARIOS_FIELDS_H_

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "scenarios/scenario.h"

template <>
struct nlohmann::adl_serializer<simbench::scenarios::ParameterValue> {
  static void to_json(json& out, const simbench::scenarios::ParameterValue& value) {
    std::visit([&out](const auto& alternative) { out = alternative; }, value);
  }
  static void from_json(const json& in, simbench::scenarios::ParameterValue& value) {
    if (in.is_boolean()) {
      value = in.get<bool>();
    } else if (in.is_number()) {
      value = in.get<double>();
    } else {
      value = in.get<std::string>();
    }
  }
};

// A choice is its word; the schema allows no other.
template <simbench::scenarios::Choice Enum>
struct nlohmann::adl_serializer<Enum, void> {
  static void to_json(json& out, Enum value) {
    out = std::string(simbench::scenarios::to_text(value));
  }
  static void from_json(const json& in, Enum& value) {
    value = simbench::scenarios::from_text<Enum>(in.get_ref<const std::string&>()).value();
  }
};

namespace simbench::scenarios {

// Calls visit(name, member) for each member of a kind of fault, in the order of messages.
template <class Kind, class Visit>
void for_each_member(Kind& fault, Visit visit) {
  if constexpr (requires { fault.camera; }) visit("camera", fault.camera);
  if constexpr (requires { fault.host; }) visit("host", fault.host);
  if constexpr (requires { fault.at_ms; }) visit("at_ms", fault.at_ms);
  if constexpr (requires { fault.duration_ms; }) visit("duration_ms", fault.duration_ms);
  if constexpr (requires { fault.step_ms; }) visit("step_ms", fault.step_ms);
  if constexpr (requires { fault.smear_ms; }) visit("smear_ms", fault.smear_ms);
  if constexpr (requires { fault.inserted; }) visit("inserted", fault.inserted);
}

// The same for an oscillator, whose class has a key that C++ keeps for itself.
template <class AnyOscillator, class Visit>
void for_each_member_of_oscillator(AnyOscillator& oscillator, Visit visit) {
  visit("class", oscillator.class_name);
  visit("skew_sigma_ppm", oscillator.skew_sigma_ppm);
  visit("white_frequency_ppb", oscillator.white_frequency_ppb);
  visit("random_walk_ppb_per_sqrt_s", oscillator.random_walk_ppb_per_sqrt_s);
  visit("wander_step_ms", oscillator.wander_step_ms);
  visit("flicker_floor_ppb", oscillator.flicker_floor_ppb);
  visit("ramp_ppm_per_hour", oscillator.ramp_ppm_per_hour);
  visit("self_heating_ppm", oscillator.self_heating_ppm);
  visit("self_heating_time_constant_s", oscillator.self_heating_time_constant_s);
  visit("temperature_coefficient_ppb_per_k", oscillator.temperature_coefficient_ppb_per_k);
}

}  // namespace simbench::scenarios

// A fault is its kind and the members of this kind. A missing member is 0 until the checks refuse
// it.
template <>
struct nlohmann::adl_serializer<simbench::scenarios::Fault> {
  static void to_json(json& out, const simbench::scenarios::Fault& fault) {
    std::visit(
        [&out](const auto& stated) {
          out = {{"kind", stated.kKind}};
          simbench::scenarios::for_each_member(
              stated, [&out](const char* name, const auto& member) { out[name] = member; });
        },
        fault);
  }
  static void from_json(const json& in, simbench::scenarios::Fault& fault) { read(in, fault); }

 private:
  template <class... Kinds>
  static void read(const json& in, std::variant<Kinds...>& fault) {
    const auto& kind = in.at("kind").get_ref<const std::string&>();
    const auto read_as = [&in, &fault](auto stated) {
      simbench::scenarios::for_each_member(stated, [&in](const char* name, auto& member) {
        if (in.contains(name)) in.at(name).get_to(member);
      });
      fault = stated;
    };
    ((kind == Kinds::kKind ? read_as(Kinds{}) : void()), ...);
  }
};

template <>
struct nlohmann::adl_serializer<simbench::scenarios::Oscillator> {
  static void to_json(json& out, const simbench::scenarios::Oscillator& oscillator) {
    simbench::scenarios::for_each_member_of_oscillator(
        oscillator, [&out](const char* name, const auto& member) { out[name] = member; });
  }
  static void from_json(const json& in, simbench::scenarios::Oscillator& oscillator) {
    simbench::scenarios::for_each_member_of_oscillator(oscillator,
                                                       [&in](const char* name, auto& member) {
                                                         if (in.contains(name))
                                                           in.at(name).get_to(member);
                                                       });
  }
};

// What a scenario does without has null, or no member.
template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  static void to_json(json& out, const std::optional<T>& value) {
    out = value ? json(*value) : json();
  }
  static void from_json(const json& in, std::optional<T>& value) {
    if (in.is_null()) {
      value.reset();
    } else {
      value = in.get<T>();
    }
  }
};

namespace simbench::scenarios {

// Members "with default" may be missing where the schema lets them; it requires all else.

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Timeline, wait_before_capture_ms, warm_up_ms, frames)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LastSet, hours_ago, skew_sigma_ppm, minutes_since_baseline)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(HostClock, oscillator, initial_offset_sigma_ms,
                                                skew_of_host_ppm, initial_offset_of_host_ms,
                                                tick_ms, resolution_ms, read_cost_ms, set_cost_ms,
                                                set_cost_session_log_sigma, set_cost_call_log_sigma,
                                                set_effective_fraction, arrival_quantum_ms,
                                                last_set)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Burst, rate_hz, duration_exponential_ms, latency_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Nic, hardware_stamps, skew_sigma_ppm, stamp_resolution_ns,
                                   stamp_jitter_sigma_ns, cross_stamp_cost_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PulseLines, pps, gnss, trigger, pps_jitter_sigma_us,
                                   interrupt_latency_us, interrupt_latency_exponential_us)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Temperature, day_amplitude_k, day_period_h, load_amplitude_k,
                                   load_period_s, load_time_constant_s, fan_amplitude_k,
                                   fan_period_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DriftFile, age_h, error_ppb)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(DelayLaw, fixed_us, exponential_us, quantiles_us,
                                                spike_probability, spike_max_us, common_share,
                                                common_time_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Stack, transmit, transmit_to_card, receive, wake_up,
                                   interrupt_moderation_us, interrupts_per_s, sleep_share,
                                   sleep_exit_us, awake_us, sleep_time_ms, speed_log_sigma)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Hosts, count, master_is_exact, clock, send_cost_ms,
                                                send_cost_exponential_ms,
                                                send_cost_session_exponential_ms,
                                                receive_wake_up_ms, load_log_sigma, nic,
                                                pulse_lines, load_burst, temperature, drift_file,
                                                stack)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Link, host, latency_fixed_ms,
                                                latency_exponential_ms, asymmetry_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WifiPowerSave, idle_ms, beacon_interval_ms, dtim_period,
                                   wake_up_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Wifi, access_point_host, wired_hosts,
                                                rate_mbit_per_s, basic_rate_mbit_per_s, preamble_us,
                                                sifs_us, slot_us, contention_window_min,
                                                contention_window_max, retry_limit,
                                                collision_probability, busy, power_save)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(
    Network, latency_fixed_ms, latency_exponential_ms, latency_session_exponential_ms,
    asymmetry_sigma_ms, port_asymmetry_sigma_ms, spike_probability, spike_max_ms,
    latency_quantiles_ms, burst, bandwidth_mbit_per_s, overhead_bytes, loss_probability,
    duplicate_probability, reorder_probability, reorder_max_ms, retransmit_timeout_ms, nagle,
    delayed_ack_ms, stamp_point, capture_traffic_share, switch_clock, switch_clock_error_ns, links,
    switch_of_host, switch_residence_ms, cross_traffic_share, switch_clock_wander_ppb_per_sqrt_s,
    wifi)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TriggerPause, at_ms, duration_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Trigger, rate_hz, rate_error_ppm, pulse_jitter_sigma_us,
                                   branch_delay_max_us, cable_delay_max_us, cameras_per_sub_trigger,
                                   start_delay_ms, daisy_chain_delay_us, missed_pulse_probability,
                                   pauses)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StreamMode, width, height, mode_rate_hz)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Stream, kind, width, height, bytes_per_pixel,
                                                mode_rate_hz, pipeline_latency_ms,
                                                latency_mode_periods, shutter, readout_ms,
                                                calibrated_delay_ms, calibrated_at)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PollDelays, request_ms, reply_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(ClockPoll, interval_ms, request_ms,
                                                request_exponential_ms, reply_ms,
                                                reply_exponential_ms, tail_probability, tail_max_ms,
                                                calibrated_asymmetry_ms, calibrated_at)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AutoExposure, step_interval_exponential_ms, min_ms, max_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CalibrationError, delay_error_sigma_ms,
                                   camera_delay_error_sigma_ms, poll_asymmetry_error_sigma_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameControlModel, adjust_frame, insert_frame, frame_length,
                                   start_at, granularity_us, shortest_ms, longest_ms,
                                   latency_frames, delay_ms, delay_exponential_ms, loss_probability,
                                   insert_stretches, insert_noise_sigma_us, start_jitter_sigma_us,
                                   frame_jitter_sigma_us, sensor_clock)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LedClockModel, interval_ms, first_ms, last_ms, step_ms,
                                   missed_probability, wrong_probability, skew_sigma_ppm,
                                   row_spread_share)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(
    Cameras, count, cameras_per_host, host_of_camera, skew_of_camera_ppm, model, sync_mode,
    common_start, start_spread_ms, streams, oscillator, clock_epoch_max_ms, latency_camera_max_ms,
    exposure_ms, exposure_camera_periods, exposure_host_periods, trigger_to_exposure_us,
    genlock_guard_fraction, slave_free_run_after_periods, sensor_stamp_jitter_sigma_us,
    drop_probability, unstable_start_ms, unstable_start_jitter_sigma_ms, clock_poll, auto_exposure,
    calibration, frame_control, led_clock, stamp_clock)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BackendStamp, host_uptime_h, resolution_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Usb, bandwidth_mb_per_s, sharing,
                                                cameras_per_controller, buffered_frames,
                                                kernel_copy_exponential_ms,
                                                delivery_jitter_transfers, host_jitter_transfers,
                                                host_jitter_correlation, spike_probability,
                                                spike_max_transfers, delivery_quantiles_ms,
                                                delivery_correlation, backend_stamp)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(HostPrograms, master, slave, files, environment,
                                                run_before_capture_s, run_during_capture, model)

// A host_sync is the name of an algorithm, or an object with programs.
inline void to_json(nlohmann::json& out, const Pipeline& pipeline) {
  out = {{"name", pipeline.name},
         {"host_sync", pipeline.host_sync},
         {"device_time", pipeline.device_time},
         {"gathering", pipeline.gathering}};
  if (pipeline.programs) out["host_sync"] = {{"program", *pipeline.programs}};
  if (!pipeline.capture_alignment.empty()) {
    out["capture_alignment"] = pipeline.capture_alignment;
  }
}
inline void from_json(const nlohmann::json& in, Pipeline& pipeline) {
  in.at("name").get_to(pipeline.name);
  in.at("device_time").get_to(pipeline.device_time);
  in.at("gathering").get_to(pipeline.gathering);
  pipeline.capture_alignment = in.value("capture_alignment", "");
  const nlohmann::json& host_sync = in.at("host_sync");
  if (host_sync.is_string()) {
    host_sync.get_to(pipeline.host_sync);
    pipeline.programs.reset();
  } else {
    pipeline.programs = host_sync.at("program").get<HostPrograms>();
    pipeline.host_sync = "program " + program_name(pipeline.programs->slave.front());
  }
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Evaluation, stream, table, gathering_interval_periods,
                                   rmdv_median)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Published, amd_ms, rmdv_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(PublishedFigure, pipeline, metric, at_most, value,
                                                at_least, conditions, source)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StudioSubject, kind, mesh_file, height_m, motion,
                                   walk_speed_m_per_s, turn_rate_rad_per_s, arm_rate_rad_per_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PublishedReprojection, mean_cm, std_cm)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Studio, radius_m, azimuth_step_deg, heights_m, look_at_height_m,
                                   portrait, calibration_translation_sigma_mm,
                                   calibration_rotation_sigma_deg, stereo_baseline_mm,
                                   subpixel_error_px, missing_share, max_incidence_deg,
                                   min_distance_m, max_distance_m, point_spacing_mm,
                                   visibility_tolerance_mm, visibility_spread_px, subject,
                                   published)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Scenario, name, summary, timeline, hosts, network,
                                                trigger, cameras, usb, faults, evaluation,
                                                algorithms, pipelines, published, published_figures,
                                                studio)

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_FIELDS_H_
