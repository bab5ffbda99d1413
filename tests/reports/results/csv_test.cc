#include "reports/results/csv.h"

#include <gmock/gmock.h>

#include <sstream>

#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;

TEST(ResultsCsv, OneLinePerPipeline) {
  EXPECT_EQ(csv(sample_results()),
            "pipeline,host_sync,device_time,gathering,amd_ms,amd_ms_p05,amd_ms_p95,rmdv_ms,"
            "rmdv_ms_p05,rmdv_ms_p95,absolute_error_ms,absolute_error_ms_p05,"
            "absolute_error_ms_p95,bias_ms,bias_ms_p05,bias_ms_p95,host_error_ms,"
            "host_error_ms_p05,host_error_ms_p95,exposure_spread_ms,exposure_spread_ms_p05,"
            "exposure_spread_ms_p95,precision,recall,margin_ms,frames_expected,frames_delivered,"
            "frames_dropped,evaluated_pulses,unsynchronised_hosts,published_amd_ms,"
            "published_amd_inside,published_amd_percentile,published_rmdv_ms,"
            "published_rmdv_inside,published_rmdv_attainable,packets_per_s,sets,pure_sets,"
            "due_pulses,exposed_pulses,partial_sets,index_errors,discarded_frames,set_amd_ms,set_"
            "absolute_error_ms,"
            "emission_latency_ms,emission_latency_max_ms,exposure_spread_median_ms,"
            "exposure_spread_p95_ms,aligned_1_ms_s,aligned_0_1_ms_s,aligned_0_01_ms_s,"
            "disturbed_frames,exposure_drift_ppm,wrong_locks,colour_offset_ms,"
            "colour_offset_spread_ms,t_l_ms,t_t_ms,t_d_ms,session_passes,get_time_ms,"
            "set_time_ms,message_time_ms,certified_ms,scored_seeds,standing,failed\n"
            "yoon2021_both,yoon2021_both,regression_30,yoon2021,2,1.5,2.5,0.75,0.5,1,29,28,30,"
            "-29,-28,-30,0.5,0.25,0.75,0.0625,0,0.125,1,0.75,8.5,34560,34557,3,960,1,2.438,1,50,"
            "1.8044,0,0,30,720,720,0,0,4,0,21,1.75,28,0.25,6,,,,,,,,,,,,,,,,,,,2,failed,"
            "hosts were not synchronised (1 over all seeds)\n"
            "free_running,free_running,raw_arrival,yoon2021,750250,500,1500000,250,200,300,,,,,,"
            ",,,,,,,,0,,0,0,0,0,0,,,,,,,,0,0,0,0,0,0,0,,,,,,,,,,,,,,,,,,,,,,,2,failed,"
            "no pulse was delivered by all cameras\n");
}

TEST(ResultsCsv, SteeredExposuresHaveTheirColumns) {
  evaluation::Results results = sample_results();
  set_steered(results.rows[0]);
  std::istringstream lines(csv(results));
  std::string line;
  std::getline(lines, line);
  EXPECT_TRUE(
      line.starts_with("pipeline,host_sync,capture_alignment,device_time,gathering,amd_ms,"))
      << line;
  std::getline(lines, line);
  EXPECT_TRUE(line.starts_with("yoon2021_both,yoon2021_both,nudge,regression_30,yoon2021,2,"))
      << line;
  EXPECT_TRUE(
      line.ends_with(",6,0.5,2,3,8,,12.5,5,0.5,,,,,,,,,,,2,failed,"
                     "hosts were not synchronised (1 over all seeds)"))
      << line;
  std::getline(lines, line);
  EXPECT_TRUE(line.starts_with("free_running,free_running,,raw_arrival,yoon2021,")) << line;
}

TEST(ResultsCsv, AChangedWorldIsTheLastColumn) {
  evaluation::Results results = sample_results();
  results.derivation = {.base = "sample", .changes = {{"/a", "1", "2"}, {"/b", "", "\"c\""}}};
  std::istringstream lines(csv(results));
  std::string line;
  std::getline(lines, line);
  EXPECT_TRUE(line.ends_with(",changed")) << line;
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    std::getline(lines, line);
    EXPECT_TRUE(line.ends_with(",\"changed: /a 1 → 2, /b none → c\"")) << line;
  }
}

TEST(ResultsCsv, PublishedFiguresHaveAColumn) {
  EXPECT_THAT(csv(sample_results()), testing::Not(HasSubstr("published_figures")));
  evaluation::Results results = sample_figure_results();
  results.published_figures[1].verdict = evaluation::FigureVerdict::kFails;
  const std::string text = csv(results);
  EXPECT_THAT(text, HasSubstr(",scored_seeds,standing,failed,published_figures"));
  EXPECT_THAT(text, HasSubstr("amd_ms at_most 2.44; amd_ms at_least 3 fails"));
}

TEST(ResultsCsv, NotesOfASimulationHaveAColumn) {
  evaluation::Results results = sample_results();
  results.rows[0].notes = {"repetition 1: a clock wandered"};
  const std::string text = csv(results);
  EXPECT_TRUE(text.substr(0, text.find('\n')).ends_with(",ground_truth,verified,notes")) << text;
  EXPECT_NE(text.find(",simulation,verified,repetition 1: a clock wandered\n"), std::string::npos);
}

TEST(ResultsCsv, FramesAndHostsOfAChangedWorldSaySo) {
  evaluation::Results results = sample_results();
  results.derivation = {.base = "sample", .changes = {{"/a", "1", "2"}, {"/b", "", "3"}}};
  for (const auto write : {write_frames_csv, write_hosts_csv}) {
    std::ostringstream out;
    write(results, out);
    std::istringstream lines(out.str());
    std::string line;
    std::getline(lines, line);
    EXPECT_TRUE(line.ends_with(",changed")) << line;
    int count = 0;
    for (; std::getline(lines, line); ++count) {
      EXPECT_TRUE(line.ends_with(",\"changed: /a 1 → 2, /b none → 3\"")) << line;
    }
    EXPECT_EQ(count, 4);
  }
}

TEST(ResultsCsv, PulsesOfASingleCameraHaveEmptyCells) {
  evaluation::Results results = sample_results();
  results.rows.resize(1);
  results.rows[0].seeds.resize(1);
  results.rows[0].seeds[0].pulses = {{.pulse = 225}};
  std::ostringstream out;
  write_frames_csv(results, out);
  EXPECT_EQ(out.str(), "pipeline,seed,pulse,amd_ms,rmdv_ms\nyoon2021_both,1,225,,\n");
}

TEST(ResultsCsv, FramesHaveALinePerPulse) {
  std::ostringstream out;
  write_frames_csv(sample_results(), out);
  EXPECT_EQ(out.str(),
            "pipeline,seed,pulse,amd_ms,rmdv_ms\n"
            "yoon2021_both,1,225,1.5,0.25\n"
            "yoon2021_both,1,226,2,0.5\n"
            "yoon2021_both,2,225,1.5,0.25\n"
            "yoon2021_both,2,226,2,0.5\n");
}

TEST(ResultsCsv, HostsSayWhetherTheyWereSynchronised) {
  std::ostringstream out;
  write_hosts_csv(sample_results(), out);
  EXPECT_EQ(out.str(),
            "pipeline,seed,host,host_error_ms,synchronised,t_l_ms,t_t_ms,t_d_ms,session_passes,"
            "get_time_ms,set_time_ms\n"
            "yoon2021_both,1,0,0,1,,,,,,\n"
            "yoon2021_both,1,1,-0.125,1,,,,,,\n"
            "yoon2021_both,2,0,0,1,,,,,,\n"
            "yoon2021_both,2,1,-0.125,0,,,,,,\n");
}

TEST(ResultsCsv, ASlaveHasTheDelaysOfItsSession) {
  evaluation::Results results = sample_results();
  set_sessions(results.rows[0]);
  std::ostringstream out;
  write_hosts_csv(results, out);
  EXPECT_THAT(out.str(), HasSubstr("\nyoon2021_both,1,0,0,1,,,,,,\n"
                                   "yoon2021_both,1,1,-0.125,1,3.5,2.25,5.75,2,0.001,4.499\n"));
}

TEST(ResultsCsv, TidyHasALineForEachSeedPipelineAndMetric) {
  evaluation::Results results = sample_results();
  const std::string text = tidy_csv(results);
  EXPECT_TRUE(text.starts_with("scenario,pipeline,seed,metric,unit,value\n")) << text;
  const std::string start = "\n" + results.scenario + ",yoon2021_both,";
  EXPECT_NE(text.find(start + "1,amd_ms,ms,1.5" + start + "2,amd_ms,ms,2.5\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find(start + "1,seed_recall,share,0.5\n"), std::string::npos);
  EXPECT_EQ(text.find("free_running,1,host_error_ms"), std::string::npos) << "it has none";
  EXPECT_EQ(text.find("nan"), std::string::npos);
  results.derivation = {.base = "sample", .changes = {{"/a", "1", "2"}}};
  EXPECT_TRUE(tidy_csv(results).starts_with("scenario,pipeline,seed,metric,unit,value,changed\n"));
}

}  // namespace
}  // namespace simbench::reports
