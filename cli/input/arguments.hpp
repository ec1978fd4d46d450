#pragma once

#include <cstdio>
#include <filesystem>

#include "core/jobs/parallel.hpp"
#include "core/jobs/tasks.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace fs = std::filesystem;

/// What the user typed.
struct Arguments {
  std::string program;  ///< as it was called: for commands to be typed next
  std::string command;
  fs::path file;                         ///< of a command that takes one
  std::vector<fs::path> files;           ///< of a command that takes several
  std::vector<std::string> overrides;    ///< "/json/pointer=value" or "variable=value"
  std::optional<std::string> load_case;  ///< the only one that is meant
  std::optional<std::string> kind;       ///< of a new problem, or of a shell
  std::optional<fs::path> output;        ///< run folder
  std::optional<fs::path> design;        ///< file with another design than the start
  std::optional<std::string> accuracy;   ///< target; one of the overrides, too
  std::optional<std::string> gap;        ///< of a front; one of the overrides, too
  std::optional<std::string> backend;
  std::optional<int> starts;        ///< designs that an optimization begins at
  std::optional<std::string> body;  ///< whose invariants are written; by default of all
  std::optional<std::string> differentiated_body;  ///< for whose invariants gradients are, too
  std::vector<std::string> methods;
  std::optional<double> difference_step;    ///< relative
  int jobs = available_threads();           ///< simulations at a time, of each rank
  bool gives_jobs = false;                  ///< they are not just what the processors allow
  std::vector<RankPlace>* ranks = nullptr;  ///< others of an MPI job, if it is one
  double task_limit = 0.0;          ///< of a start, a point or some samples [s]; 0: any time
  bool wants_optimum = false;       ///< accuracy of it, and of whole optimizations
  bool wants_histories = false;     ///< with their derivatives
  bool compares_methods = false;    ///< of gradients: effort and accuracy of all
  std::vector<std::string> names;   ///< of histories that are drawn
  std::string order = "time";       ///< of runs that are listed: "time" or "name"
  bool wants_all_warnings = false;  ///< those that follow from others, too
  Scrutiny scrutiny = Scrutiny::usual;
  bool is_verbose = false;     ///< audit, prices, drives, effects, too
  bool wants_effects = false;  ///< what each effect brings and costs
  bool wants_json = false;
  bool wants_vtk = false;          ///< the motion as files for ParaView
  bool leaves_out_report = false;  ///< no report.html
  bool overwrites = false;         ///< an older run of the same command in the folder
  bool allows_programs = false;    ///< those that the problem names
  bool resumes = false;            ///< goes on with such a run, as far as it came
  std::vector<std::string> words;  ///< the command line as it was

  TaskOptions tasks() const { return {jobs, task_limit, ranks}; }

  /// Where lines appear while the work goes on: standard output belongs to JSON if that is wanted.
  std::FILE* progress() const { return wants_json ? stderr : stdout; }
};

/// @returns nothing if help or the version was asked for and printed
/// @throws InputError for anything that is not a command line of pleuel
std::optional<Arguments> parse_arguments(int argc, const char* const* argv);

}  // namespace pleuel
