// Hostile input by the thousand: robustness mutants|worlds|faults COUNT [SEED [INDEX]]
//
//   mutants  damages a file or an argument of every kind that the command line reads
//   worlds   runs worlds from anywhere in the permitted ranges; Ctrl-C at any moment, at the latest
//            after a second
//   faults   lets reading a good file fail after so many bytes
//
// Whatever the input, a command ends in 10 s, within 1 GB, without a signal or an internal error,
// prints neither nan nor inf, and hears Ctrl-C within 1 s of work (tests/robustness/child.h).
//
// How many were accepted all the same is printed by kind: a reader that refuses every mutant is not
// tried behind its first lines.
//
// Attempts are numbered; with INDEX only that one is made, and its command line and messages are
// printed.
// Exit status: 0 all fine, 1 a problem (each is printed with the command that repeats it), 2 usage.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "recording/version.h"
#include "tests/robustness/child.h"
#include "tests/robustness/inputs.h"
#include "tests/robustness/random.h"
#include "tests/robustness/worlds.h"
#include "tests/scratch_folder.h"

namespace simbench::robustness {
namespace {

constexpr double kLatestInterruptS = 1;
constexpr int kMostReports = 20;  // of each worker

struct Settings {
  std::string mode;
  std::uint64_t count = 0;
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> index{};
};

struct Result {
  std::string kind;
  std::vector<std::string> arguments;
  Ending ending;
  std::optional<std::string> problem;
};

// One of the attempts by its number, in a worker of its own.
using Attempts = std::function<Result(Random&)>;

Result try_mutant(Inputs& inputs, Random& random) {
  const Attempt attempt = inputs.next(random);
  // A sweep or a run with other numbers may take its time.
  const Ending ending =
      call({.arguments = attempt.arguments, .interrupt_after_s = kLatestInterruptS});
  inputs.restore(attempt);
  return {attempt.kind, attempt.arguments, ending, problem_of(ending, attempt.input)};
}

Result try_fault(Inputs& inputs, Random& random) {
  const Attempt attempt = inputs.undamaged(random);
  const auto bytes = static_cast<std::uint64_t>(random.log_between(1, 1e6)) - 1;
  const Ending ending = call({.arguments = attempt.arguments,
                              .interrupt_after_s = kLatestInterruptS,
                              .fault = ReadFault{inputs.folder(), bytes}});
  inputs.restore(attempt);
  return {attempt.kind, attempt.arguments, ending, problem_of(ending)};
}

Result try_world(const Worlds& worlds, Random& random) {
  const std::vector<std::string> arguments = worlds.next(random);
  const double interrupt_after_s =
      random.one_in(3) ? random.log_between(1e-3, kLatestInterruptS) : kLatestInterruptS;
  const Ending ending = call({.arguments = arguments, .interrupt_after_s = interrupt_after_s});
  return {"worlds", arguments, ending, problem_of(ending)};
}

// "--set '/a=b'": arguments as a shell takes them.
std::string command_line(const std::vector<std::string>& arguments) {
  std::string text;
  for (const std::string& argument : arguments) {
    text += fmt::format("{}{:?}", text.empty() ? "" : " ", argument.substr(0, 300));
  }
  return text;
}

void print_problem(const Settings& settings, std::uint64_t index, const Result& result) {
  fmt::print("{}: {}\n  robustness {} 1 {} {}   (commit {})\n", command_line(result.arguments),
             *result.problem, settings.mode, settings.seed, index, commit());
  std::fflush(stdout);
}

// How many attempts of a kind there were, and how many ended well.
struct Count {
  std::uint64_t accepted = 0;
  std::uint64_t made = 0;
};
using Counts = std::map<std::string, Count>;

std::string counts_text(const Counts& counts) {
  std::string text;
  for (const auto& [kind, count] : counts) {
    text += fmt::format("{} {} {}\n", count.accepted, count.made, kind);
  }
  return text;
}

// Adds what workers have written.
Counts counts_in(std::FILE* lines) {
  Counts counts;
  unsigned long long accepted = 0;
  unsigned long long made = 0;
  char kind[128];
  while (std::fscanf(lines, "%llu %llu %127s", &accepted, &made, kind) == 3) {
    counts[kind].accepted += accepted;
    counts[kind].made += made;
  }
  return counts;
}

// Every `workers`th attempt from `first` on; returns whether all were fine.
bool work(const Settings& settings, unsigned first, unsigned workers, Counts& counts) {
  const ScratchFolder folder;
  std::optional<Inputs> inputs;
  std::optional<Worlds> worlds;
  if (settings.mode == "worlds") {
    worlds.emplace();
  } else {
    inputs.emplace((folder.path() / "inputs").string());
  }
  std::filesystem::create_directory(folder / "here");
  std::filesystem::current_path(folder / "here");
  const auto attempt = [&](std::uint64_t index) {
    Random random(settings.seed, index);
    if (worlds) return try_world(*worlds, random);
    return settings.mode == "faults" ? try_fault(*inputs, random) : try_mutant(*inputs, random);
  };
  if (settings.index) {
    const Result result = attempt(*settings.index);
    fmt::print("{}\nstatus {}, signal {}, {:.3f} s, {} MB\n{}{}\n", command_line(result.arguments),
               result.ending.status, result.ending.signal, result.ending.seconds,
               result.ending.peak_bytes >> 20U, result.ending.output, result.ending.messages);
    if (result.problem) print_problem(settings, *settings.index, result);
    return !result.problem;
  }
  int problems = 0;
  for (std::uint64_t index = first; index < settings.count && problems < kMostReports;
       index += workers) {
    const Result result = attempt(index);
    Count& count = counts[result.kind];
    ++count.made;
    // 3 is a verdict.
    if (result.ending.status == 0 || result.ending.status == 3) ++count.accepted;
    if (!result.problem) continue;
    ++problems;
    print_problem(settings, index, result);
  }
  return problems == 0;
}

bool work_guarded(const Settings& settings, unsigned first, unsigned workers, Counts& counts) {
  try {
    return work(settings, first, workers, counts);
  } catch (const std::exception& error) {
    fmt::print("robustness: {}\n", error.what());
    return false;
  }
}

// A process for each core, since processes with threads are not forked.
bool run(const Settings& settings) {
  Counts counts;
  if (settings.index) return work_guarded(settings, 0, 1, counts);
  const unsigned workers = std::max(1U, std::thread::hardware_concurrency());
  std::FILE* const counted = std::tmpfile();
  if (counted == nullptr) throw std::runtime_error("no temporary file");
  std::fflush(stdout);
  for (unsigned worker = 0; worker < workers; ++worker) {
    const pid_t process = fork();
    if (process != 0) continue;
    const bool fine = work_guarded(settings, worker, workers, counts);
    std::fflush(stdout);
    const std::string text = counts_text(counts);
    const bool told =
        write(fileno(counted), text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(fine && told ? 0 : 1);
  }
  bool fine = true;
  for (int status = 0; wait(&status) > 0;) fine = fine && status == 0;
  std::rewind(counted);
  for (const auto& [kind, count] : counts_in(counted)) {
    fmt::print("{}: {} of {} accepted\n", kind, count.accepted, count.made);
  }
  std::fclose(counted);
  fmt::print("{} {}, seed {}: {}\n", settings.count, settings.mode, settings.seed,
             fine ? "fine" : "problems");
  return fine;
}

std::optional<std::uint64_t> number(const char* text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), value);
  if (error != std::errc() || *end != '\0') return std::nullopt;
  return value;
}

std::optional<Settings> settings_of(int argc, char** argv) {
  if (argc < 3 || argc > 5) return std::nullopt;
  const std::string mode = argv[1];
  if (mode != "mutants" && mode != "worlds" && mode != "faults") return std::nullopt;
  std::vector<std::uint64_t> numbers;
  for (int i = 2; i < argc; ++i) {
    const auto value = number(argv[i]);
    if (!value) return std::nullopt;
    numbers.push_back(*value);
  }
  Settings settings{.mode = mode, .count = numbers[0]};
  if (numbers.size() > 1) settings.seed = numbers[1];
  if (numbers.size() > 2) settings.index = numbers[2];
  return settings;
}

}  // namespace
}  // namespace simbench::robustness

int main(int argc, char** argv) {
  const auto settings = simbench::robustness::settings_of(argc, argv);
  if (!settings) {
    fmt::print(stderr, "usage: robustness mutants|worlds|faults COUNT [SEED [INDEX]]\n");
    return 2;
  }
  return simbench::robustness::run(*settings) ? 0 : 1;
}
