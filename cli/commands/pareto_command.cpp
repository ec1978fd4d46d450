#include "cli/commands/commands.hpp"
#include "cli/reports/starts_report.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "studies/missing_settings.hpp"
#include "studies/pareto_point.hpp"

namespace pleuel {

namespace {

/// Of a limit that holds in several load cases the first.
const ConstraintSettings& varied_constraint(const ProblemFile& problem) {
  return problem.constraints[varied_rows(problem).front()];
}

/// What the front trades against the objective: a response, that of the worst of several cases, or a
/// sum of variables by its name.
std::string limited_name(const ProblemFile& problem) {
  const std::vector<std::size_t> varied = varied_rows(problem);
  const ConstraintSettings& first = problem.constraints[varied.front()];
  if (first.response.empty()) return first.name;
  if (varied.size() == 1) return first.response;
  const OfCase of_case = problem.case_constraints[varied.front()];
  const ProblemFile& one = problem.cases[of_case.load_case];
  return name_in_case(one.constraints[of_case.index].response, "worst");
}

/// pareto.csv: a line for each point, first as it is found, in the end by its limit [SI].
std::vector<CsvColumn> pareto_columns(const ProblemFile& problem) {
  const Json::json_pointer objectives("/objectives"), variables("/variables");
  std::vector<CsvColumn> columns = columns_at({"/status", "/limit"});
  columns.push_back({"objective", objectives / problem.objective->response});
  columns.push_back({"limited", objectives / limited_name(problem)});
  columns.push_back({"multiplier", Json::json_pointer("/multiplier")});
  for (const DesignVariable& variable : problem.variables) {
    columns.push_back({"variable:" + variable.name, variables / variable.name});
  }
  const auto effort = columns_at({"/kkt_residual", "/evaluations", "/seconds"});
  columns.insert(columns.end(), effort.begin(), effort.end());
  return columns;
}

Json point_document(const ProblemFile& problem, const ParetoPoint& point) {
  Json document = {{"status", to_string(point.result.status)},
                   {"message", point.result.message},
                   {"limit", point.limit},
                   {"dominated", point.is_dominated},
                   {"objectives", Json::object()},
                   {"variables", Json::object()}};
  if (point.has_design()) {
    document["warnings"] = point.result.warnings;
    document["error"] = error_document(point.result.error);
    const double sign = problem.objective->sign();
    document["objectives"] = {
        {problem.objective->response, sign * point.result.evaluation.objective},
        {limited_name(problem), point.limited_value}};
    if (point.objective_limit) document["objective_limit"] = sign * *point.objective_limit;
    if (point.has_multiplier()) document["multiplier"] = sign * point.multiplier;
  }
  document["variables"] = by_name(problem.variables, point.result.x);
  const Json sizes = sizes_of(problem, point.result.x);
  if (!sizes.empty()) document["sizes"] = sizes;
  if (point.sizes) {
    document["choices"] = {{"combinations", point.sizes->combinations},
                           {"tried", point.sizes->tried},
                           {"exhaustive", point.sizes->is_exhaustive},
                           {"penalty", point.sizes->penalty}};
  }
  document["kkt_residual"] = point.result.kkt_residual;
  document["evaluations"] = point.result.evaluations;
  document["seconds"] = point.result.seconds;
  return document;
}

/// "mass against the limit of bow", or "mass against sag" between two responses.
std::string front_text(const ProblemFile& problem) {
  return fmt::format("{} against {}{}", problem.objective->response,
                     problem.pareto->goals.empty() ? "the limit of " : "",
                     problem.pareto->goals.empty() ? problem.pareto->constraint
                                                   : problem.pareto->goals[1].response);
}

std::string single_point_text(const ProblemFile& problem, const ParetoFront& front) {
  const bool is_of_both = !problem.pareto->goals.empty() && front.points.size() == 1;
  if (!is_of_both || !front.points.front().keeps_limits()) return "";
  if (!front.choices && !front.points.front().is_end) return "";
  return "One design is best for both responses: there is nothing to trade.\n";
}

/// What all choices of sizes came to, where they were simulated.
std::string choices_message(const ParetoFront& front) {
  const ChoiceCounts& counts = *front.choices;
  const std::string failed =
      counts.failed > 0 ? fmt::format(", and {} could not be simulated", counts.failed) : "";
  const std::string tried = fmt::format("all {} choices of sizes were tried{}", counts.all, failed);
  if (counts.feasible == 0) return tried + "; none keeps the limits other than the one that varies";
  return fmt::format(
      "{}; the limits other than the one that varies are kept by {}, and the points are those of "
      "them that no other one dominates{}",
      tried, counts.feasible, front.points.empty() ? ": none of them is between the limits" : "");
}

bool is_not_proven_best(const ParetoPoint& point) {
  return point.has_design() && point.sizes && !point.sizes->is_exhaustive;
}

/// Of sizes that were chosen at each limit, where not all were tried; empty of other fronts.
std::string sizes_message(const ParetoFront& front) {
  int points = 0, least = 0, most = 0;
  double combinations = 0.0, penalty = 0.0;
  for (const ParetoPoint& point : front.points) {
    if (!is_not_proven_best(point)) continue;
    const TriedSizes& sizes = *point.sizes;
    least = points == 0 ? sizes.tried : std::min(least, sizes.tried);
    most = std::max(most, sizes.tried);
    combinations = sizes.combinations;
    penalty = std::max(penalty, sizes.penalty);
    ++points;
  }
  if (points == 0) return "";
  const std::string tried =
      least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  return fmt::format(
      "at {} of {} points the choice of sizes is the best that was found, not proven the best of "
      "all: {} of {} choices were tried for a point; the objective is up to {} worse than the "
      "optimum between the sizes, and a better choice may be between",
      points, front.points.size(), tried, combinations, percent(penalty));
}

Json make_document(const ProblemFile& problem, const ParetoFront& front) {
  const ConstraintSettings& constraint = varied_constraint(problem);
  const std::vector<ParetoPoint>& points = front.points;
  Json document = {{"status", study_status(front.is_whole)},
                   {"constraint", problem.pareto->constraint},
                   {"units",
                    {{problem.objective->response,
                      unit_of(find_response(problem, problem.objective->response)).si},
                     {limited_name(problem), unit_of(problem, constraint).si}}},
                   {"points", Json::array()}};
  if (front.choices) {
    document["message"] = choices_message(front);
    document["choices"] = {{"combinations", front.choices->all},
                           {"feasible", front.choices->feasible},
                           {"failed", front.choices->failed}};
  } else if (const std::string sizes = sizes_message(front); !sizes.empty()) {
    document["message"] = sizes;
  } else if (problem.pareto->gap > 0.0 && front.is_whole) {
    document["message"] = gaps_message(problem, front, limited_name(problem));
    document["gaps"] = gaps_document(problem, front);
  }
  const std::optional<std::size_t> knee = find_knee(points, good_side(problem));
  for (std::size_t i = 0; i < points.size(); ++i) {
    document["points"].push_back(point_document(problem, points[i]));
    document["points"].back()["knee"] = knee == i;
  }
  return document;
}

/// What the limit of a point is called: of a front between two responses there is none in the file.
std::string limit_title(const ProblemFile& problem) {
  if (problem.pareto->goals.empty()) return "limit";
  return limited_name(problem) + (varied_constraint(problem).upper ? " at most" : " at least");
}

/// "verified, knee"
std::string point_status(const std::string&, const Json& point) {
  const auto is_set = [&](const char* key) { return point.at(key).get<bool>(); };
  const bool is_proven = point.value("/choices/exhaustive"_json_pointer, true);
  return text_at(point, "/status") + (is_set("dominated") ? ", dominated" : "") +
         (is_set("knee") ? ", knee" : "") +
         (!is_proven && !point.at("objectives").empty() ? ", best found" : "");
}

std::string points_text(const ProblemFile& problem, const Json& points) {
  const ShownUnit limited = unit_of(problem, varied_constraint(problem));
  const std::string name = limited_name(problem), &objective = problem.objective->response;
  const ShownUnit goal = unit_of(find_response(problem, objective));
  const ShownUnit rate{"", goal.name + "/" + limited.name, goal.factor / limited.factor};
  std::vector<DocumentColumn> columns = {
      column_in(limited, limit_title(problem), "/limit"),
      column_in(limited, name, place_in("/objectives", name)),
      column_in(goal, objective, place_in("/objectives", objective)),
      column_in(goal, "±", "/error/total", 2), column_in(rate, "multiplier", "/multiplier", 3)};
  const NamedUnits units = units_of_variables(problem);
  for (const DesignVariable& variable : problem.variables) {
    DocumentColumn column =
        column_in(units.at(variable.name), variable.name, place_in("/variables", variable.name));
    if (variable.has_choices()) {
      column.title = variable.name;
      column.text = [=, number = column.text](const std::string&, const Json& point) {
        const std::string size = text_at(point, place_in("/sizes", variable.name));
        return size.empty() ? number("", point) : size;
      };
    }
    columns.push_back(std::move(column));
  }
  columns.push_back({"status", point_status, Table::Align::left});
  return table_of(points, columns).text();
}

/// A line on all choices of sizes, or on the gaps that were asked for.
std::string spacing_text(const Json& front) {
  const std::string message = text_at(front, "/message");
  if (message.empty()) return "";
  return "\n" + wrapped((front.contains("gaps") ? "Gaps: " : "Sizes: ") + message + ".", "  ") +
         "\n";
}

/// With a gap, or of all choices of sizes, nobody knows how many points there would have been.
std::string interruption_text(const ProblemFile& problem, const ParetoFront& front) {
  if (front.is_whole) return "";
  const std::size_t found = front.points.size();
  if (problem.pareto->gap > 0.0 || front.choices) {
    return fmt::format("INTERRUPTED: {} points were done, more would have come\n\n", found);
  }
  return interrupted_text(found, problem.pareto->points, "points");
}

std::size_t verified_points(const std::vector<ParetoPoint>& points) {
  return static_cast<std::size_t>(std::ranges::count_if(
      points, [](const ParetoPoint& point) { return point.result.status == Status::verified; }));
}

/// That there are, or would be as far as that is known.
std::size_t all_points(const ProblemFile& problem, const ParetoFront& front) {
  if (front.is_whole || front.choices || problem.pareto->gap > 0.0) return front.points.size();
  return static_cast<std::size_t>(problem.pareto->points);
}

/// "7 of 7 points verified"
std::string count_text(const ProblemFile& problem, const ParetoFront& front) {
  const auto unproven = std::ranges::count_if(front.points, is_not_proven_best);
  return fmt::format("{} of {} points verified{}", verified_points(front.points),
                     all_points(problem, front),
                     unproven > 0 ? fmt::format(", at {} not all sizes tried", unproven) : "");
}

/// "limit 120 MPa"
std::string limit_text(const ProblemFile& problem, double limit) {
  const ShownUnit unit = unit_of(problem, varied_constraint(problem));
  return fmt::format("limit {} {}", significant(unit.shown(limit)), unit.name);
}

/// Why points are not verified, a sentence each, and what speaks against their numbers.
std::string findings_text(const ProblemFile& problem, const std::vector<ParetoPoint>& points) {
  std::string text;
  SharedWarnings warnings;
  for (const ParetoPoint& point : points) {
    const Result& result = point.result;
    const std::string limit = limit_text(problem, point.limit);
    warnings.add(result.warnings, limit);
    if (result.status == Status::verified) continue;
    text += wrapped(fmt::format("  {}: {}: {}\n", limit, to_string(result.status), result.message),
                    "    ");
  }
  const std::string warned = warnings_text(warnings.sentences());
  return (text.empty() ? "" : "\nNOT VERIFIED:\n" + text) + (warned.empty() ? "" : "\n" + warned);
}

/// The mechanisms of the front, by their numbers from 1.
Json front_picture(const ProblemFile& problem, const std::vector<ParetoPoint>& points) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> designs;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].has_design()) designs.emplace_back(std::to_string(i + 1), points[i].result.x);
  }
  return rigid_picture(*simulated_problems(problem).front(), designs);
}

/// A line for each point, with how long the others take if they take as long as those so far.
class PointLines {
 public:
  PointLines(const Arguments& arguments, const ProblemFile& problem)
      : problem_(problem), progress_(arguments, "the first points") {}

  void see(const ParetoPoint& point) {
    ++done_;
    const ParetoSettings& settings = *problem_.pareto;
    const int left = settings.gap > 0.0 ? 0 : settings.points - done_;
    const double seconds = left * stopwatch_.seconds() / done_;
    progress_.print(fmt::format("  {}: {} after {} evaluations, {}{}",
                                limit_text(problem_, point.limit), to_string(point.result.status),
                                point.result.evaluations, duration(point.result.seconds),
                                left > 0 ? fmt::format("; about {} left", duration(seconds)) : ""));
    progress_.expect(fmt::format("{} points", done_), seconds);
  }

 private:
  const ProblemFile& problem_;
  ProgressLine progress_;
  Stopwatch stopwatch_;
  int done_ = 0;
};

}  // namespace

Outcome run_pareto(const Arguments& arguments) {
  const ProblemInput input = read_input_with_accuracy(arguments);
  const ProblemFile problem = trade_off_problem(input.problem);
  require_pareto(problem);
  const SolveOptions options = solve_options(problem, arguments);
  const Json used = options_document(options, problem);
  RunRecord record(arguments, input, used);
  RunStore store(record, arguments, input, used);
  show_warnings_before(problem);
  record.begin_phase("pareto");
  std::optional<DocumentCsv> csv;  // with the first result
  PointLines lines(arguments, problem);
  const auto observer = [&](const ParetoPoint& point) {
    if (!csv) csv.emplace(record.result("pareto.csv"), pareto_columns(problem));
    csv->add(point_document(problem, point));
    lines.see(point);
  };
  const ParetoFront front = pareto_front(problem, options, {arguments.tasks(), &store}, observer);
  const std::vector<ParetoPoint>& points = front.points;
  const Json document = make_document(problem, front);
  DocumentCsv in_order(record.result("pareto.csv"), pareto_columns(problem));
  for (const Json& point : document["points"]) in_order.add(point);
  const bool is_verified =
      front.is_whole && !points.empty() && verified_points(points) == points.size();
  Outcome outcome{is_verified ? ExitCode::done : ExitCode::not_verified, document,
                  fmt::format("{}{}: {}; {}\n\n{}{}{}{}\n", interruption_text(problem, front),
                              problem.name, front_text(problem), count_text(problem, front),
                              points_text(problem, document["points"]), spacing_text(document),
                              single_point_text(problem, front), findings_text(problem, points))};
  store.finish(outcome);
  record.finish(outcome, [&] { return front_picture(problem, points); });
  return outcome;
}

}  // namespace pleuel
