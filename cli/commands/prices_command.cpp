#include <set>

#include "cli/commands/commands.hpp"
#include "cli/reports/iteration_lines.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/size_choice.hpp"
#include "studies/number_prices.hpp"
#include "studies/point_searches.hpp"

namespace pleuel {

namespace {

/// The residual up to which multipliers explain a design: those of `optimize` are prices up to it.
constexpr double nearly_optimal = 1e-2;
/// Lines of the table: what else there is stands in prices.csv.
constexpr std::size_t most_lines = 25;

/// The design that prices are of, and what is known of it.
struct AnalyzedDesign {
  Eigen::VectorXd x;
  std::string verdict;  ///< of the optimization, if there was one
  bool is_optimum = true;
  std::vector<std::string> warnings;
};

AnalyzedDesign described(const Result& result) {
  const bool is_optimum = result.status == Status::verified || result.status == Status::unresolved;
  return {result.x, fmt::format("{}: {}", to_string(result.status), result.message), is_optimum,
          result.warnings};
}

/// The choice of sizes, whose prices are those with these sizes.
AnalyzedDesign find_best_sizes(const ProblemInput& input, const SolveOptions& options) {
  AnalyzedDesign design = described(search_with_sizes(input.problem, options, nullptr).result);
  design.verdict +=
      "; these are prices with the sizes that were chosen, as they stay for small changes";
  return design;
}

AnalyzedDesign find_optimum(const ProblemInput& input, const Arguments& arguments) {
  const SolveOptions options = solve_options(input.problem, arguments);
  if (has_choices(input.problem)) return find_best_sizes(input, options);
  DesignProblem problem(input.problem, arguments.jobs);
  IterationLines lines(arguments.progress(), input.problem);
  const Result result =
      solve_design(problem, options, [&](const EvaluationRecord& record) { lines.see(record); });
  return described(result);
}

AnalyzedDesign given_design(const ProblemInput& input) {
  const auto analysis = analyze(input.problem, input.design);
  AnalyzedDesign design{input.design, "", true,
                        texts_of(check_run(input.problem, input.design, *analysis))};
  const std::vector<std::string> broken =
      broken_limits(limits_document(input.problem, input.design, *analysis, {}));
  if (broken.empty()) return design;
  design.is_optimum = false;
  design.warnings.insert(
      design.warnings.begin(),
      fmt::format("the design breaks {}: these are no prices of an optimum within its limits",
                  quoted_list(broken, "and")));
  return design;
}

const char* kind_name(NumberPrice::Kind kind) {
  static constexpr std::array<const char*, 4> names = {"number", "variable", "bound", "limit"};
  return names[static_cast<std::size_t>(kind)];
}

Json price_document(const NumberPrice& price) {
  Json document = {{"value", price.value},
                   {"unit", price.unit.si},
                   {"shown_unit", {{"name", price.unit.name}, {"factor", price.unit.factor}}},
                   {"per_unit", price.per_unit},
                   {"per_percent", price.per_percent()},
                   {"kind", kind_name(price.kind)}};
  if (price.pointers.size() > 1) document["with"] = price.pointers;
  if (!price.next_limit.empty()) document["next_limit"] = price.next_limit;
  return document;
}

Json make_document(const ProblemFile& problem, const AnalyzedDesign& design,
                   const PriceList& list) {
  const std::string& name = problem.objective->response;
  Json document = {{"status", design.is_optimum ? "done" : "no optimum"},
                   {"verdict", design.verdict},
                   {"objective",
                    {{"name", name},
                     {"value", list.objective},
                     {"unit", unit_of(find_response(problem, name)).si}}},
                   {"kkt_residual", list.residual},
                   {"prices", named_entries(list.prices, price_document)},
                   {"variables", Json::object()},
                   {"unknown", list.unknown},
                   {"warnings", design.warnings}};
  const Json values = by_name(problem.variables, design.x);
  for (const auto& [variable, x] : values.items()) document["variables"][variable]["value"] = x;
  return document;
}

/// prices.csv: all prices in the order of the table [SI].
void write_csv(const ResultFile& file, const PriceList& list) {
  CsvFile csv(file, {"name", "kind", "value", "unit", "per_unit", "per_percent", "next_limit"});
  for (const NumberPrice& price : list.prices) {
    csv.add({price.name, kind_name(price.kind), price.value, price.unit.si, price.per_unit,
             price.per_percent(), price.next_limit});
  }
}

std::string short_name(std::string name) {
  if (name.starts_with("/scene/")) name = name.substr(7);
  if (name.starts_with("/")) name = name.substr(1);
  return name;
}

std::string shown_name(const NumberPrice& price) {
  const std::string name = short_name(price.name);
  const std::size_t others = price.pointers.size() - 1;
  return others > 0 ? fmt::format("{} (+{})", name, others) : name;
}

std::string prices_text(const ProblemFile& problem, const PriceList& list) {
  const ShownUnit objective = unit_of(find_response(problem, problem.objective->response));
  Table table({left_aligned("number"), "value", left_aligned("unit"),
               fmt::format("{}/unit", objective.name), fmt::format("{} at +1 %", objective.name),
               "at +1 %", left_aligned("")});
  std::size_t lines = 0;
  for (const NumberPrice& price : list.prices) {
    if (price.per_unit == 0.0) continue;
    if (++lines > most_lines) break;
    const double percent = price.per_percent();
    const double share = list.objective == 0.0 ? 0.0 : 100.0 * percent / std::abs(list.objective);
    table.add_row({shown_name(price), significant(price.unit.shown(price.value)), price.unit.name,
                   signed_significant(objective.shown(price.per_unit) * price.unit.factor, 4),
                   signed_significant(objective.shown(percent), 4),
                   price.value == 0.0 ? "–" : signed_significant(share, 4) + " %",
                   price.next_limit.empty() ? "" : "*"});
  }
  return table.text();
}

/// What decides beyond the prices with a star.
std::string next_limits_text(const PriceList& list) {
  std::set<std::string> names;
  for (const NumberPrice& price : list.prices) {
    if (price.per_unit != 0.0 && !price.next_limit.empty()) names.insert(price.next_limit);
  }
  if (names.empty()) return "";
  return fmt::format("* holds for less than 1 %: before that {} begins to decide, too. ",
                     fmt::join(names, " or "));
}

std::string left_out_text(const PriceList& list) {
  std::size_t priced = 0;
  for (const NumberPrice& price : list.prices) priced += price.per_unit != 0.0;
  const std::size_t free = list.prices.size() - priced;
  std::string text;
  if (priced > most_lines) {
    text += fmt::format("{} smaller ones stand in prices.csv. ", priced - most_lines);
  }
  if (!list.unknown.empty()) {
    constexpr std::size_t most_names = 3;
    std::vector<std::string> names;
    for (const std::string& name : list.unknown) {
      if (names.size() < most_names) names.push_back(short_name(name));
    }
    const std::size_t more = list.unknown.size() - names.size();
    text += fmt::format(
        "Not known: what {}{} would change (a place on an elastic beam keeps its share of the "
        "length, a periodic motion its period). ",
        fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
  }
  if (free > 0) text += fmt::format("Without influence on the optimum: {} more. ", free);
  return text;
}

std::string report(const ProblemFile& problem, const AnalyzedDesign& design,
                   const PriceList& list) {
  const ShownUnit unit = unit_of(find_response(problem, problem.objective->response));
  std::string text = design.verdict.empty() ? "" : "\n" + wrapped(design.verdict) + "\n\n";
  text += wrapped(
      fmt::format("{}: what one percent more of each number changes of the optimum, {} = {} {}\n\n",
                  problem.name, problem.objective->response,
                  significant(unit.shown(list.objective)), unit.name));
  text += prices_text(problem, list) + "\n";
  text += wrapped(next_limits_text(list) + left_out_text(list) +
                  "In brackets: how many numbers of the file move with it, as those of a shared "
                  "point.") +
          "\n";
  return text + warnings_text(design.warnings);
}

/// A design whose multipliers explain nothing has no prices.
void check_design(AnalyzedDesign& design, const PriceList& list) {
  if (list.residual <= nearly_optimal) return;
  design.is_optimum = false;
  design.warnings.insert(
      design.warnings.begin(),
      fmt::format(
          "the design is no optimum (KKT residual {}): these are no prices of it. Give that "
          "of an optimization which ended verified, or none",
          magnitude(list.residual)));
}

}  // namespace

Outcome run_prices(const Arguments& arguments) {
  const ProblemInput input = read_input_with_accuracy(arguments);
  const SolveOptions options = solve_options(input.problem, arguments);
  RunRecord record(arguments, input, options_document(options, input.problem));
  show_warnings_before(input.problem);
  record.begin_phase("optimize");
  AnalyzedDesign design = arguments.design ? given_design(input) : find_optimum(input, arguments);
  record.begin_phase("prices");
  const PriceList list = number_prices(input.text, input.problem, design.x, arguments.jobs);
  check_design(design, list);
  Outcome outcome{design.is_optimum ? ExitCode::done : ExitCode::not_verified,
                  make_document(input.problem, design, list), report(input.problem, design, list)};
  write_csv(record.result("prices.csv"), list);
  record.finish(outcome, [&] {
    return run_picture(input.problem, {{input.design_name, input.design}});
  });
  return outcome;
}

}  // namespace pleuel
