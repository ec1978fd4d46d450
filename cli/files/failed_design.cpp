#include "cli/files/failed_design.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "cli/files/command_text.hpp"
#include "cli/files/csv_file.hpp"
#include "cli/reports/scene_report.hpp"
#include "cli/text/wrapped_text.hpp"

namespace pleuel {

namespace {

constexpr const char* dossier_name = "failed_design.json";

/// For the folder in which the optimization was called. Where gradients were asked for, they are
/// what may have failed.
std::string command_again(const RunRecord& record, const Arguments& arguments,
                          const ProblemFile& problem, const EvaluationRecord& failed) {
  const bool takes_gradients =
      failed.request != Request::values ||
      std::ranges::any_of(problem.constraints, [](const ConstraintSettings& constraint) {
        return constraint.deviations > 0.0;
      });
  return command_at(takes_gradients ? "gradient" : "simulate", arguments,
                    record.folder() / dossier_name);
}

}  // namespace

void write_failed_design(RunRecord& record, const Arguments& arguments, const ProblemFile& problem,
                         const EvaluationRecord& failed) {
  record.write(dossier_name, {{"evaluation", failed.evaluation},
                              {"request", to_string(failed.request)},
                              {"failure", failed.failure},
                              {"command", command_again(record, arguments, problem, failed)},
                              {"variables", variables_document(problem, failed.x)}});
}

std::string failed_design_text(const RunRecord& record, const Arguments& arguments,
                               const ProblemFile& problem, const History& history) {
  const auto last =
      std::find_if(history.rbegin(), history.rend(), std::mem_fn(&EvaluationRecord::has_failed));
  if (last == history.rend()) return "";
  const std::string sentence = fmt::format(
      "{} of {} evaluations failed; the last such design is in {}, and this runs it again:\n",
      count_failures(history), history.size(), (record.folder() / dossier_name).string());
  return wrapped(sentence, "  ") +
         fmt::format("  {}\n", command_again(record, arguments, problem, *last));
}

}  // namespace pleuel
