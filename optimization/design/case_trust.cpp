#include "optimization/design/case_trust.hpp"

#include <utility>

#include "core/response/monitors.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/case_doubts.hpp"

namespace pleuel {

namespace {

Trust trust_of(DesignCase& of_case, const Eigen::VectorXd& x, Scrutiny scrutiny) {
  const Analysis& analysis = of_case.analysis_at(x);
  const Monitors monitors = monitor(analysis.model, analysis.trajectory);
  return judge_run(TrustedRun{of_case.file(), x, analysis, monitors, scrutiny});
}

}  // namespace

Trust judge_cases(DesignProblem& design, const Eigen::VectorXd& x, Scrutiny scrutiny) {
  const ProblemFile& file = design.file();
  if (!file.has_cases()) return trust_of(design.load_case(0), x, scrutiny);
  std::vector<std::vector<Doubt>> doubts;
  Trust all;
  all.errors.resize(file.responses.size());
  all.evidence.resize(file.responses.size());
  all.bands.resize(file.responses.size());
  bool has_errors = false, has_bands = false;
  for (std::size_t c = 0; c < design.case_count(); ++c) {
    Trust one = trust_of(design.load_case(c), x, scrutiny);
    doubts.push_back(std::move(one.doubts));
    for (std::size_t i = 0; i < file.responses.size(); ++i) {
      if (is_over_cases(file, i) || file.case_responses[i].load_case != c) continue;
      const std::size_t here = file.case_responses[i].index;
      has_errors = has_errors || !one.errors.empty();
      has_bands = has_bands || !one.bands.empty();
      if (!one.errors.empty()) all.errors[i] = one.errors[here];
      if (!one.evidence.empty()) all.evidence[i] = one.evidence[here];
      if (!one.bands.empty()) all.bands[i] = one.bands[here];
    }
  }
  if (!has_errors) {
    all.errors.clear();
    all.evidence.clear();
  }
  if (!has_bands) all.bands.clear();
  all.doubts = joined_doubts(file, doubts);
  return all;
}

}  // namespace pleuel
