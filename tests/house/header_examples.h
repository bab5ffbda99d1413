// What the examples in the headers' comments take as given; header_examples.awk says how they are
// compiled. Nothing here is defined: the examples are compiled, never run.
//
// A name that examples only hand on is declared as `Whatever`; one whose members they use has its
// type, in the innermost namespace in which all examples mean the same by it.
#pragma once

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

namespace simbench {

// An argument of any type, or a function that takes and gives anything.
struct Whatever {
  template <typename T>
  operator T&() const;
  template <typename... Arguments>
  Whatever operator()(Arguments&&...) const;
};

// What a coroutine returns.
struct Returned {
  template <typename T>
  Returned(T&&);
};

// A T, and whatever else examples of the same namespace call by that name.
template <typename T>
struct Given : T {
  template <typename U>
  operator U&() const;
};

extern const Whatever whatever, use, print, correct_the_clock, oscillator, os_time, kernel_stamp;

// algorithms/
struct MySettings {
  void bind(ParameterBinder&);
};
class Mine : public DeviceTimeEstimator {
 public:
  explicit Mine(const MySettings&);
  GlobalTime stamp(const DeviceSample&) override;
};
Task<void> serve(Host&, PeerId);
Task<void> tell_the_others(Sighting);
extern const Whatever adjustment, cameras, line, x, y, w, own_clock, key, master, offset;
extern const std::size_t capacity, extra;
extern const std::uint32_t sources, camera;
extern std::vector<DeviceSample> frames;
extern const std::vector<LedSample> sightings;
extern std::vector<GlobalTime> global;
extern Given<DeviceSample> sample, first;
extern const Given<GatherFrame> frame;
extern const LinePoint point;
extern const GatheringSetup setup;
extern const std::shared_ptr<const CodedPulses> pulses;
extern const CodeDecoderSettings settings;
extern const TriggerCode code;
extern const std::int64_t at_ns;
extern FrameSetSink& set_sink;
extern const GlobalTime stamp;
extern const std::int64_t frame_index, offset_ns, t1_ns, t2_ns, t3_ns, t4_ns;
extern const Parameters parameters;
extern ChronySourceStats stats;
extern double now_s, left_s, offset_s, delay_s, dispersion_s, slope;
extern const SteadyTime s, steady, seen, when, deadline, at;
extern const Given<SteadyTime> now;
extern const Nanoseconds measured;
extern const Whatever step;
extern const HostTime m, t1;
extern Host& host;
extern HardwareClock& clock;
extern MessageChannel& channel;
extern OutcomeReport& outcome;
extern RawClock raw;
extern const LowerHull above, below_negated;
extern const ReceivedMessage message;
extern const std::vector<PeerId> peers, slaves;
extern const TwoWayExchange exchange;
extern TwoWayEstimator& estimator;
extern DeviceTimeEntry entry;

// laws/
struct Draws {
  double uniform();
  double exponential(double mean);
  bool chance(double probability);
};
extern Draws draws;

// recording/, and what several folders use
extern const scenarios::Scenario scenario;
extern const std::uint64_t seed, run_seed;
extern RecordingSource& source;
extern ClockSource& clock_source;
extern const ClockRequest clock_request;
extern ClockSink& clock_sink;
extern RecordingSink &sink, &scorer, &first_scorer, &second_scorer;
extern const std::unique_ptr<HostSync> sync;
extern HostSync& host_sync;
extern WorldObserver& observer;
extern const RecordingRequest request;
extern const RecordingCost cost;
extern const RecordingFolder folder;
extern const Whatever capture;
extern const FrameRecord record;
extern const std::optional<FrameTruth> truth;
extern const RecordingEvent event;
extern const std::string text;
extern const DevicePoll poll;
extern const RecordedStreams recorded;
extern std::ostream& file;

namespace app {
using evaluation::evaluate;
using hardware::NetworkSandbox;
using sim::make_simulation;
extern const std::vector<evaluation::PipelineChoice> choices;
extern const std::vector<std::string> arguments;
extern const Whatever played, progress;
extern const evaluation::EvaluationOptions options;
extern const hardware::ExperimentRig rig;
extern RecordingSource& rig_source;
inline constexpr int kInterrupted = 130;
extern const evaluation::SourceFactory make_source;
extern const evaluation::Results results;
}  // namespace app

namespace cli {
using evaluation::evaluate;
extern const std::vector<evaluation::PipelineChoice> choices;
extern Command& command;
extern const Whatever kValidateExamples, validate_all;
extern const evaluation::SourceFactory make_source;
extern const evaluation::EvaluationOptions options;
extern std::unique_ptr<RecordingSource> source;
}  // namespace cli

namespace evaluation {
using scenarios::Scenario;
using sim::make_simulation;
std::string task_text(std::size_t task);
std::string answer_in(const std::string& setup, const std::string& task);
extern const std::vector<ResponseRow> rows;
extern const Whatever pipeline, make_world, make_clocks, base, fit, simulated, measured, stream,
    choice, make_estimator, workspace, layout, arrival, shift, before, after, keep, results, truth,
    global;
extern CsvRecordingReader reader;
extern const FitInput input;
extern const std::unique_ptr<RecordingSource> own_source;
extern const std::vector<PipelineChoice> choices;
extern Given<ScorerSetup> setup;
extern PulseTable table;
extern PipelineScorer scorer;
extern ScoreObserver& observer;
extern Gatherer& gatherer;
extern EstimatorBank& bank;
extern FrameBlock& block;
extern SeedScore seed_score;
extern std::int64_t tag;
extern const Series with, without;
extern const Row row;
extern const RareFunction rare_function;
extern const SweepPlan plan;
extern const std::vector<std::size_t> missing;
extern std::vector<std::optional<SweepScore>> scores;
extern std::atomic<bool> interrupted;
extern const std::vector<HostLog> logs;
extern const CameraDelays delays, delays_a, delays_b;
extern const StreamFacts facts_a, facts_b;
extern const LoggedClock host_clock;
extern const std::vector<DelayJump> jumps;
extern const std::vector<FrameGap> gaps;
extern const StampGrid grid;
extern const std::vector<double> offsets_ms;
extern const ErrorOfClock error_a, error_b;
}  // namespace evaluation

namespace hardware {
extern boost::asio::io_context& context;
extern CameraDriver &driver, &cameras;
extern Camera& camera;
extern const Rig rig;
extern const std::vector<Rig> rigs;
extern const Whatever key, me, settings, report, play, id, peer, admit, starts, secret, transcript,
    header, message, handler, received, send_at, forward, read, endpoint_of_node_j, bytes,
    kernel_stamp, os_time, now, oscillator, port, at;
extern const SessionWorld world;
extern boost::system::error_code error;
extern const boost::asio::ip::address address;
extern boost::asio::ip::tcp::socket socket;
extern SessionPlan plan;
extern const PipelineFactory make_pipeline;
extern const std::function<void(const std::string&)> log_line, log;
extern const TriggerSwitch::Prompt prompt;
extern std::unique_ptr<SecureStream> stream;
extern NodeClock& clock;
extern PeerNetwork& network;
extern const std::shared_ptr<CameraFeed> feed;
extern Journal journal;
extern Notice& notice;
extern const std::vector<int> messages;
extern DelayQueue& queue;
extern NetworkLaw &forward_law, &backward_law;
extern boost::asio::ip::tcp::socket a;
extern const MonotonicTime deadline;
extern const SteadyTime steady_deadline;
extern std::uint64_t counter;
extern int broken;
extern Bytes chunk;
extern const std::string folder;
}  // namespace hardware

namespace server {
extern const RequestHead head;
PageResponse page(const PageRequest& request);
}  // namespace server

namespace explore {
extern const reports::Json json;
extern const std::string body;
extern const PageSubject subject;
extern const LookRequest request;
extern const std::shared_ptr<server::PageStream> stream;
extern const scenarios::Scenario world;
extern const evaluation::Results results;
extern const reports::ResultsAnswer answer;
extern const evaluation::Progress progress;
}  // namespace explore

namespace watch {
extern const std::vector<evaluation::ClockLogPoint> points;
extern const std::vector<RecordedStream> streams;
extern Monitor monitor;
extern const double phase_ms, common_ms, period_ms;
extern const WatchEvent event;
}  // namespace watch

namespace reconstruction {
extern const Whatever seen, focal_px, options, on_mesh, progress, by_vertex, zbuffer, measured, set,
    make_simulated, errors_of_the_set, frame;
extern const bool reconstructed, gathered;
extern const scenarios::Studio studio;
extern const Eigen::Vector3d point;
extern TriangleMesh mesh;
extern const Given<Pinhole> camera;
extern ReprojectionRow row;
}  // namespace reconstruction

namespace reports {
extern const Whatever law, simulated, path, manifest, identity, begin, end, work_on, refuse,
    provenance, measured, summary, run, choice, results, mesh, rows, clocks, diagnosis;
extern const evaluation::ClockAccount account;
extern const Archive a, b;
extern const SeedRange seeds_of_a, seeds_of_b;
extern const evaluation::Row row_a, row_b;
extern const evaluation::Results all_results;
extern Figure figure;
extern FigureSeries dense;
extern const evaluation::SweepPlan plan;
extern const Trace trace;
extern const std::vector<Figure> figures;
extern const std::vector<Block> blocks;
extern const AnswerText answer;
extern Document document;
extern const evaluation::Row row;
extern std::string cell;
extern std::unique_ptr<RecordingSource> source;
}  // namespace reports

namespace sim {
struct Lamp {
  void toggle();
};
extern Lamp lamp;
extern Engine engine;
extern VirtualContext& context;
double draw(std::int64_t index);
extern const std::int64_t step_ns;
extern const Whatever settings, slot, expose, frequency_at_zero, t_ns, to, from, id, copy,
    direction, offset, bytes, world, clocks, handler, kReadout, path, message, send, send_ack,
    schedule, deliver, lose;
extern const TrueTime now, at, arrival, start, capture_start, capture_end, camera_start, then, t;
extern const Nanoseconds residence;
extern const SystemClock system_clock;
extern const SwitchClock clock;
extern Shutter shutter;
extern Given<RandomStream> stream;
extern Port port;
extern Cpu cpu;
extern SimHost& host;
extern const TriggerLine& trigger_line;
extern const DriftFiles& drift_files;
extern const scenarios::Wifi wifi;
extern const scenarios::LeapSecond leap;
extern SystemClock& leaping_clock;
extern const HostTime zero;
extern const double coefficient_ppb_per_k;
extern FrameFeeds feeds;
extern FrameSupply& frame_supply;
extern CameraWorld& camera_world;
extern const CameraFaults camera_faults;
extern ClockSampling sampling;
extern std::vector<TrueTime> timers;
extern const ComponentKey kMessage;
extern HostGroup& hosts;
extern Capture& capture;
void start_capture();
void expect_frame();
extern WorldObserver& observer;
extern Endpoint& endpoint;
extern const RunLoad load;
extern const Outages outages;
extern SimNetwork network;
extern const std::size_t host_count;
extern const std::uint64_t link_and_direction, message_index;
extern std::vector<int> messages;
extern WaitPoint arrived;
extern Given<FrameArrival> frame;
extern const Whatever arrival_quantum, copied, delivered;
extern const TrueTime at_card, left;
extern const TrueTime deadline;
extern const SteadyTime steady_deadline;
extern int count;
}  // namespace sim

}  // namespace simbench
