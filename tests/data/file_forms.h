// A small file of every form of docs/files.md that is text, and the commands of that page.
//
//   for (const auto& [name, content] : file_forms()) folder.write(name, content);
//   for (const std::vector<std::string>& command : commands_of_files_page()) run(command);
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/deflated.h"

namespace simbench {
namespace forms {

inline constexpr int kLines = 40;

inline int offset_ns(int i) { return i * 7919 % 101 - 50; }

inline std::string repeated(const std::function<std::string(int)>& line,
                            const std::string& begin = "") {
  std::string text = begin;
  for (int i = 0; i < kLines; ++i) text += line(i) + "\n";
  return text;
}

inline std::string update(int i) {
  return fmt::format("[{}.052] master offset {} s2 freq -25211 path delay 635", 3906 + i,
                     offset_ns(i));
}

inline std::string iso(int i) {
  return fmt::format("2024-09-03T10:{:02}:{:02}", 32 + i / 60, i % 60);
}

inline std::map<std::string, std::string> linuxptp_files() {
  const auto start = [](int i) {
    return i < 2 ? fmt::format("ptp4l[{}.0]: master offset -37242662790 s{} freq -1 path delay 6",
                               i, i)
                 : fmt::format("ptp4l[{}.0]: master offset {} s2 freq -1 path delay 6", i,
                               offset_ns(i));
  };
  const auto two = [](int i) {
    return fmt::format("Sep 03 10:32:22 node1 ptp4l[{}]: {}", 700 + i % 2, update(i));
  };
  const auto json = [](int i) {
    return fmt::format(R"({{"_HOSTNAME":"n","SYSLOG_IDENTIFIER":"ptp4l","MESSAGE":"{}"}})",
                       update(i));
  };
  return {
      {"ptp4l.log", repeated([](int i) { return "ptp4l" + update(i).insert(10, ":"); })},
      {"journal.txt",
       repeated([](int i) { return "Sep 03 10:32:22 node1 ptp4l[263]: " + update(i); },
                "-- Journal begins --\nSep 03 10:32:20 node1 systemd[1]: Started PTP.\n")},
      {"journal.json", repeated(json)},
      {"pod.log", repeated([](int i) {
         return iso(i) + ".123456789Z stdout F ptp4l" + update(i).insert(10, ":");
       })},
      {"summaries.log", repeated([](int i) {
         return fmt::format("ptp4l[{}.1]: rms 67 max 73 freq +1 +/- 5 delay 241 +/- 0", i);
       })},
      {"startup.log", repeated(start)},
      {"two.log", repeated(two)},
  };
}

inline std::map<std::string, std::string> daemon_files() {
  const auto day = [](int i) { return fmt::format("2024-09-03 10:32:{:02}", i); };
  return {
      {"tracking.log", repeated([&](int i) {
         return fmt::format(
             "{} 203.0.113.15 2 -3.541 0.075 {:e} N 2 2.9e-06 -2e-04 1e-02 3e-04 8e-03", day(i),
             1e-9 * offset_ns(i));
       })},
      {"statistics.log", repeated([&](int i) {
         return fmt::format("{} {} 6.2e-03 {:e} 2.2e-03 1.8e-06 1.0e-06 7.8e-02 16 0 8 0.00",
                            day(i), i % 2 == 0 ? "PPS0" : "192.0.2.1", 1e-9 * offset_ns(i));
       })},
      {"measurements.log", repeated([&](int i) {
         return fmt::format(
             "{} 203.0.113.15 N 2 111 111 1111 10 10 1.0 {:e} 2.2e-01 1.5e-05 1.6e-01 "
             "7.4e-03 CB00717B 4B D K",
             day(i), 1e-9 * offset_ns(i));
       })},
      {"refclocks.log", repeated([&](int i) {
         return fmt::format("{}.000123 PPS 0 N 1 {:e} 6.4e-08 1.0e-07", day(i),
                            1e-9 * offset_ns(i));
       })},
      {"chronyc.csv", repeated([](int i) {
         return fmt::format(
             "CB00710F,203.0.113.15,2,{}.5,0.000001,{:.9f},0.1,-3.5,0.0,0.1,0.01,0.001,"
             "64.2,Normal",
             1725359542 + 64 * i, 1e-9 * offset_ns(i));
       })},
      {"loopstats", repeated([](int i) {
         return fmt::format("60200 {}.031 {:.9f} 13.77 0.00035 0.013 6", 80000 + 16 * i,
                            1e-9 * offset_ns(i));
       })},
      {"rawstats", repeated([](int i) {
         const double sent_s = 3934440000 + 16 * i;
         const double offset_s = 1e-9 * offset_ns(i);
         return fmt::format("60557 {}.160 192.0.2.1 192.0.2.2 {:.6f} {:.6f} {:.6f} {:.6f}",
                            43200 + 16 * i, sent_s + 0.1, sent_s + 0.1002 + offset_s,
                            sent_s + 0.1003 + offset_s, sent_s + 0.1005);
       })},
      {"peerstats", repeated([](int i) {
         return fmt::format("60200 {}.031 {} 961a {:.9f} 0.0 0.00025 0.00009", 80000 + 16 * i,
                            i % 2 == 0 ? "127.127.28.0" : "192.0.2.1", 1e-9 * offset_ns(i));
       })},
      {"sntp.txt", repeated([&](int i) {
         return fmt::format(
             "{}.448103 (-0200) {:+.6f} +/- 0.018346 pool.example 192.0.2.36 s2 no-leap", day(i),
             1e-6 * offset_ns(i));
       })},
      {"shm.txt", repeated(
                      [](int i) {
                        return fmt::format("sample NTP2 {0}.0008 {0}.{1:09} {0}.000000000 0 -30",
                                           1579299789 + i, 17500 + offset_ns(i));
                      },
                      "ntpshmmon version 1\n")},
      {"stripchart.txt",
       repeated(
           [](int i) { return fmt::format("06:39:{:02}, {:+013.7f}s\r", i, 1e-6 * offset_ns(i)); },
           "Tracking time.example [192.0.2.1:123].\r\n")},
      {"rdtsc.csv", repeated(
                        [](int i) {
                          return fmt::format("{}, {}, {}, 00.0396100, {:+.7f}", 1000 + i, 1001 + i,
                                             130852169372513840 + 20'000'000LL * i,
                                             1e-6 * offset_ns(i));
                        },
                        "RdtscStart, RdtscEnd, FileTime, RoundtripDelay, NtpOffset\n")},
      {"ticc.txt", repeated([](int i) {
         return fmt::format("{}.{:012} chA\n{}.5 chB", i, 500'000 + offset_ns(i), i);
       })},
      {"interval.txt",
       repeated([](int i) { return fmt::format("{:+.12f} TI(A->B)", 1e-9 * offset_ns(i)); })},
      {"timesyncd.log", repeated([](int i) {
         return fmt::format(
             "Sep 03 10:32:{:02} n systemd-timesyncd[4]: interval/delta/delay/jitter/"
             "drift 64s/{:+.3f}s/0.012s/0.000s/+12ppm",
             i, 1e-3 * offset_ns(i));
       })},
      {"ptpd.csv", repeated([&](int i) {
         return fmt::format("{}.5, slv, 0011(unknown)/1, 0.000012345, {:.9f}, 0", day(i),
                            1e-9 * offset_ns(i));
       })},
  };
}

inline std::string utf16(const std::string& ascii) {
  std::string bytes = "\xff\xfe";
  for (const char c : ascii) bytes.append({c, '\0'});
  return bytes;
}

inline std::map<std::string, std::string> table_files() {
  const auto rows = [](const std::string& pattern, const std::string& heading) {
    return repeated([&](int i) { return fmt::format(fmt::runtime(pattern), i, offset_ns(i)); },
                    heading);
  };
  const std::string errors = rows("{},{}", "time_s,offset_ns\n");
  return {
      {"errors.csv", errors},
      {"plain.csv", rows("{},{}", "t,offset\n")},
      {"comma.csv", repeated([](int i) { return fmt::format("{},5;{},25", i, offset_ns(i)); },
                             "Zeit_s;offset_ns\n")},
      {"iso.csv", repeated([](int i) { return fmt::format("{}Z,{}", iso(i), offset_ns(i)); },
                           "time,offset_ns\n")},
      {"epoch.csv",
       repeated([](int i) { return fmt::format("{}000000000,{}", 1725359542 + i, offset_ns(i)); },
                "time_ns,offset_ns\n")},
      {"savetxt.csv", repeated(
                          [](int i) {
                            return fmt::format("{:.18e},{:.18e}", static_cast<double>(i),
                                               static_cast<double>(offset_ns(i)));
                          },
                          "# time_s,offset_ns\n")},
      {"utf16.csv", utf16(errors)},
      {"errors.csv.gz", deflated("gzip", errors)},
      {"wide.csv", rows("{},{},7,8", "time,offset_ns,freq_ppb,delay_ns\n")},
      {"phase.txt", repeated([](int i) { return fmt::format("{:e}", 1e-9 * offset_ns(i)); })},
      {"frequency.txt", repeated([](int i) { return fmt::format("{:e}", 1e-9 * offset_ns(i)); })},
      {"series.csv", repeated(
                         [](int i) {
                           return fmt::format("{},1,{},1,{:.12f}",
                                              i % 2 == 0 ? "two_way_hull" : "ntp", i / 2,
                                              1e-9 * offset_ns(i));
                         },
                         "pipeline,seed,time_s,host,te_s\n")},
  };
}

inline std::string rsdc() {
  return repeated(
      [](int i) { return fmt::format("Depth,0,{},{}.333,{}.5", i, 1000 + 33 * i, 5 + 33 * i); },
      "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n");
}

inline std::map<std::string, std::string> folders_of_cameras() {
  const std::string euroc = repeated(
      [](int i) { return fmt::format("{},{}.png", 1700000000000000000 + 50'000'000LL * i, i); },
      "#timestamp [ns],filename\n");
  const std::string tum =
      repeated([](int i) { return fmt::format("17000001{:02}.003014 {}.png", i, i); }, "# a\n");
  const std::string kitti =
      repeated([](int i) { return fmt::format("2011-09-26 13:02:{:02}.964389445", i); });
  return {
      {"MH_01_easy/mav0/cam0/data.csv", euroc},
      {"MH_01_easy/mav0/cam1/data.csv", euroc},
      {"freiburg1_xyz/rgb.txt", tum},
      {"freiburg1_xyz/depth.txt", tum},
      {"2011_09_26_drive_0001_sync/image_00/timestamps.txt", kitti},
      {"2011_09_26_drive_0001_sync/image_01/timestamps.txt", kitti},
      {"csv_rig/front.csv", rsdc()},
      {"csv_rig/back.csv.gz", deflated("gzip", rsdc())},
  };
}

inline std::map<std::string, std::string> camera_files() {
  const auto stamps = [](const std::string& heading) {
    return repeated(
        [](int i) { return fmt::format("{},{}.png", 1700000000000000000 + 50'000'000LL * i, i); },
        heading);
  };
  return {
      {"rsdc.csv", rsdc()},
      {"MH01.txt",
       repeated([](int i) { return fmt::format("{}", 1700000000123455872 + 50'000'000LL * i); })},
      {"cam0/data.csv", stamps("#timestamp [ns],filename\n")},
      {"cam1/data.csv", stamps("#timestamp [ns],filename\n")},
      {"rgb.txt",
       repeated([](int i) { return fmt::format("17000001{:02}.003014 rgb/{}.png", i, i); },
                "# rgb maps\n# timestamp filename\n")},
      {"timestamps.txt",
       repeated([](int i) { return fmt::format("2011-09-26 13:02:{:02}.964389445", i); })},
      {"frames.csv",
       repeated([](int i) { return fmt::format("{},{},{:.3f}", i, 33'333 * i, 0.033333 * i); },
                "seq,cam_us,host_s\n")},
      {"bare.csv", repeated([](int i) { return fmt::format("{};{:.3f}", 33 * i, 0.033 * i); })},
      {"ticks.csv",
       repeated([](int i) { return fmt::format("{},{}", 4'166'666LL * i, 33'333'333LL * i); },
                "ticks,host_ns\n")},
      {"quoted.csv",
       repeated([](int i) { return fmt::format("\"{0:.3f}\",\"{0:.3f}\"", 0.033 * i); },
                "\"cam_ts\",\"host_ts\"\n")},
      {"sets.csv",
       repeated([](int i) { return fmt::format("{},{},{}", 33 * i, 33 * i + 1, 33 * i + 5); },
                "left_ms,right_ms,host_ms\n")},
  };
}

}  // namespace forms

// By name.
inline std::map<std::string, std::string> file_forms() {
  std::map<std::string, std::string> all;
  for (const auto& some : {forms::linuxptp_files(), forms::daemon_files(), forms::table_files(),
                           forms::camera_files(), forms::folders_of_cameras()}) {
    all.insert(some.begin(), some.end());
  }
  return all;
}

// The commands between backticks in the tables of the page.
inline std::vector<std::vector<std::string>> commands_of_files_page() {
  std::ifstream page(SIMBENCH_SOURCE_DIR "/docs/files.md");
  std::vector<std::vector<std::string>> commands;
  for (std::string line; std::getline(page, line);) {
    const std::size_t begin = line.rfind("| `simbench ");
    if (begin == std::string::npos) continue;
    std::istringstream words(line.substr(begin + 12, line.rfind('`') - begin - 12));
    std::vector<std::string>& command = commands.emplace_back();
    for (std::string word; words >> word;) command.push_back(word);
  }
  return commands;
}

}  // namespace simbench
