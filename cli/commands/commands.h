// The commands of simbench, a function each that adds one to a command line (cli/command.h).
//
// A new command is a file NAME_command.cc with such a function, its line here and its place in the
// list of cli/command_line.cc; help, completion and man page follow.
#pragma once

#include <string>

namespace simbench::cli {

struct CommandLine;

// Every pipeline of a scenario over many seeds, then the table.
void add_run_command(CommandLine& line);
// The response of every pipeline to parameters of the scenario.
void add_sweep_command(CommandLine& line);
// The hosts' clocks alone, for hours: time error and stability.
void add_clocks_command(CommandLine& line);
// What desynchronisation costs a 3D reconstruction, the paper's Table 4. Goes on as
// simbench-reconstruct if this program lacks the libraries.
void add_reconstruct_command(CommandLine& line);

// Everything that the paper measured, beside what is printed.
void add_paper_command(CommandLine& line);

// Which rigs of real parts meet a requirement, the cheapest first.
void add_advise_command(CommandLine& line);

// A world changed by hand in a browser.
void add_explore_command(CommandLine& line);
// Result archives as one HTML file.
void add_report_command(CommandLine& line);
// One run of one pipeline as a timeline, for the Perfetto UI or PlotJuggler.
void add_trace_command(CommandLine& line);
// One figure as a file for a paper (SVG, PDF) or as data (CSV).
void add_figure_command(CommandLine& line);

// Two archives, or pipelines of one, seed by seed.
void add_compare_command(CommandLine& line);
// A result against a baseline.
void add_gate_command(CommandLine& line);

// What a bag or another recording has.
void add_inspect_command(CommandLine& line);
// The frames that belong together, as places in the files.
void add_export_command(CommandLine& line);
// Captures of a scenario as a recording folder.
void add_record_command(CommandLine& line);
// The scores of a recording folder; device_time and gathering over CSV of real cameras.
void add_replay_command(CommandLine& line);
// Whether the hardware sync of a recorded rig works.
void add_diagnose_command(CommandLine& line);
// Cameras and clocks while their files grow.
void add_watch_command(CommandLine& line);
// How far the frames of each set can be apart, for sure.
void add_certify_command(CommandLine& line);
// How stable a measured clock is, from the logs of other programs.
void add_stability_command(CommandLine& line);
// A scenario made of a recording.
void add_fit_command(CommandLine& line);
// Recordings of the IBL camera rigs as CSV for `simbench replay`.
void add_convert_ibl_command(CommandLine& line);

// The key that the hosts of a rig share.
void add_keygen_command(CommandLine& line);
// One host of a real rig.
void add_node_command(CommandLine& line);
// The real-network experiment beside its simulation.
void add_validate_model_command(CommandLine& line);
// Measured figures of real rigs beside what the bench predicts of them.
void add_reality_command(CommandLine& line);
// The network of a scenario between nodes on this machine.
void add_relay_command(CommandLine& line);

// Scenarios, algorithms, cameras, studies and figures.
void add_list_command(CommandLine& line);
// Every parameter of a scenario or an algorithm, with unit, meaning and source.
void add_describe_command(CommandLine& line);
// Scenario files checked without running them.
void add_validate_command(CommandLine& line);
// A coded trigger: its pulses, what cameras make of them, its table for a timer.
void add_code_command(CommandLine& line);

// Texts about the command line itself. `manual` knows the commands that were added before it.
void add_help_command(CommandLine& line);
void add_completion_command(CommandLine& line);
void add_manual_command(CommandLine& line);

// All studies by name, with the question that each answers: `list studies`, `sweep --study list`.
std::string study_list();

// All figures, with what they show: `list figures`, `figure --list`.
std::string figure_list();

}  // namespace simbench::cli
