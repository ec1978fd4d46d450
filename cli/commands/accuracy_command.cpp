#include "cli/commands/commands.hpp"
#include "cli/reports/accuracy_report.hpp"
#include "studies/accuracy_run.hpp"

namespace pleuel {

namespace {

std::string run_line(const std::string& setting, double seconds, const std::string& failure) {
  return fmt::format("  {}: {}", setting, failure.empty() ? duration(seconds) : "failed");
}

/// Elements by steps, which times go with.
double work_of(const Discretization& settings) {
  return (settings.elements > 0 ? settings.elements : settings.factor) / settings.step;
}

/// How long the runs of the grid still take: a guess from the work of the reference, put right by
/// how long those took that are done. Short runs are repeated until some half a second is full.
struct GridProgress {
  ProgressLine& line;
  std::vector<Discretization> grid;
  std::optional<Stopwatch> begin = {};  ///< with the reference
  std::size_t done = 0;
  double seconds_a_work = 0.0;

  void see(const AccuracyRun& run) {
    if (!begin) {
      begin.emplace();
      seconds_a_work = run.seconds() / work_of(run.settings);
    } else {
      ++done;
    }
    double guess_done = 0.0, guess_left = 0.0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      (i < done ? guess_done : guess_left) += guess(grid[i]);
    }
    const double ratio = done > 0 ? begin->seconds() / guess_done : 1.0;
    line.expect(fmt::format("{} of {} runs", done, grid.size()), ratio * guess_left);
  }

 private:
  double guess(const Discretization& settings) const {
    return std::max(0.6, 2.0 * seconds_a_work * work_of(settings));
  }
};

/// accuracy.csv: a line for each run as it is done [SI]; empty cells where nothing is known.
std::vector<CsvColumn> accuracy_columns(const ProblemFile& problem) {
  const Json::json_pointer run;
  std::vector<CsvColumn> columns =
      columns_at({"/settings/step", "/elements", "/work/steps", "/work/newton_iterations",
                  "/work/factorizations", "/simulation_seconds", "/gradient_seconds"});
  for (const std::string kind : {"error", "gradient_error"}) {
    for (const ResponseSettings& one : problem.responses) {
      columns.push_back({kind + ":" + one.name, run / (kind + "s") / one.name});
    }
  }
  columns.push_back({"failure", run / "failure"});
  return columns;
}

/// Elements, or by how much those of the file are multiplied.
Json csv_line(const ProblemFile& problem, const AccuracyRun& run) {
  Json line = run_document(problem, run);
  line["elements"] = elements_text(run.settings);
  return line;
}

/// Writes accuracy.csv from the first result on, and tells what is done.
AccuracyObserver make_observer(const ProblemFile& problem, RunRecord& record,
                               std::optional<DocumentCsv>& csv, ProgressLine& progress,
                               GridProgress& grid) {
  AccuracyObserver observer;
  observer.run = [&](const AccuracyRun& run) {
    if (!csv) csv.emplace(record.result("accuracy.csv"), accuracy_columns(problem));
    csv->add(csv_line(problem, run));
    progress.print(run_line(setting_text(run.settings), run.seconds(), run.failure));
    grid.see(run);
  };
  observer.variation = [&](const VariedRun& one) {
    progress.print(run_line(variation_text(one.variation), one.run.seconds(), one.run.failure));
    progress.show_share("other knobs and effects", 0.0);
  };
  return observer;
}

/// The optimum with the setting of the file: that of --design, or what is found from the start.
Eigen::VectorXd find_optimal_design(const ProblemInput& input, const Arguments& arguments,
                                    EvaluationStore& store) {
  if (arguments.design) return input.design;
  const Result result =
      plain_optimum(input.problem, solve_options(input.problem, arguments), &store);
  if (result.status == Status::interrupted) throw Stopped{};
  if (result.x.size() == 0 || result.status == Status::failed) {
    throw SimulationError("there is no optimum to look at: " + result.message);
  }
  show(stderr,
       fmt::format("  optimum with the setting of the file: {}\n", to_string(result.status)));
  return result.x;
}

/// What the command found.
struct Answer {
  AccuracyStudy study;
  std::optional<OptimumStudy> optima;

  bool is_interrupted() const { return study.is_interrupted || (optima && optima->is_interrupted); }
};

Answer find_answer(const ProblemInput& input, const Arguments& arguments, RunRecord& record,
                   RunStore& store) {
  const ProblemFile& problem = input.problem;
  if (arguments.wants_optimum) record.begin_phase("optimize");
  const Eigen::VectorXd x =
      arguments.wants_optimum ? find_optimal_design(input, arguments, store) : input.design;
  record.begin_phase("accuracy");
  const PricedDesign design(problem, x);
  std::optional<DocumentCsv> csv;
  ProgressLine progress(arguments, "the reference");
  GridProgress grid{progress, accuracy_grid(problem)};
  const AccuracyObserver observer = make_observer(problem, record, csv, progress, grid);
  Answer answer{accuracy_study(problem, design, observer, &store), std::nullopt};
  vary_settings(problem, design, answer.study, observer, &store);
  if (!arguments.wants_optimum || answer.study.is_interrupted) return answer;
  record.begin_phase("optima");
  progress.show_share("optimizations", 0.0);
  answer.optima = optimum_study(
      problem, x, answer.study, solve_options(problem, arguments),
      [&](const OptimumRun& run) {
        progress.print(
            run_line("optimum with " + setting_text(run.settings), run.seconds, run.failure));
      },
      &store);
  return answer;
}

/// Writes the diagrams that there are numbers for.
void write_charts(const ProblemFile& problem, const Answer& answer, RunRecord& record) {
  write_file(record.result("accuracy.svg"), to_svg(value_chart(problem, answer.study)));
  if (!problem.variables.empty()) {
    write_file(record.result("accuracy-gradients.svg"),
               to_svg(gradient_chart(problem, answer.study)));
  }
  if (answer.optima && !answer.optima->reference.has_failed()) {
    write_file(record.result("accuracy-optimum.svg"),
               to_svg(optimum_chart(problem, *answer.optima)));
  }
}

}  // namespace

Outcome run_accuracy(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  const ProblemFile& problem = input.problem;
  const Json used = arguments.wants_optimum
                        ? options_document(solve_options(problem, arguments), problem)
                        : Json::object();
  RunRecord record(arguments, input, used);
  RunStore store(record, arguments, input, used);
  show_warnings_before(problem);
  const Answer answer = find_answer(input, arguments, record, store);
  const OptimumStudy* optima = answer.optima ? &*answer.optima : nullptr;
  Outcome outcome{answer.is_interrupted() ? ExitCode::not_verified : ExitCode::done,
                  accuracy_document(input, answer.study),
                  accuracy_text(problem, answer.study, optima, arguments.is_verbose)};
  if (optima != nullptr) add_optima(input, *optima, outcome.document);
  if (answer.is_interrupted()) outcome.document["status"] = study_status(false);
  outcome.text += "\n";
  write_charts(problem, answer, record);
  store.finish(outcome);
  record.finish(outcome, [&] { return run_picture(problem, {{input.design_name, input.design}}); });
  return outcome;
}

}  // namespace pleuel
