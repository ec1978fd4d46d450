#include "tests/honesty/judged_values.hpp"

#include <cmath>
#include <map>
#include <memory>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/refined_runs.hpp"
#include "core/trust/resolution.hpp"

namespace pleuel::test {

namespace {

/// Of the largest number of a history.
constexpr double round_off = 1e-9;
constexpr double fine_step = 0.125, fine_elements = 4.0;
constexpr int more_modes = 2;

RefinedRun fine_run(const JudgedScene& scene, const Refinement& refinement) {
  return make_refined_run(scene.file, scene.x, refinement);
}

/// The reference, a coarser one, and one a number of elements with fine steps only.
struct References {
  RefinedRun finest, coarser;
  std::map<double, RefinedRun> in_time;

  explicit References(const JudgedScene& scene)
      : finest(fine_run(scene, {fine_step, fine_elements, more_modes})),
        coarser(fine_run(scene, {2.0 * fine_step, 0.5 * fine_elements, more_modes})) {
    for (const Coarseness& one : scene.coarseness) {
      if (!in_time.contains(one.elements)) {
        in_time[one.elements] = fine_run(scene, {fine_step, one.elements});
      }
    }
  }
};

double magnitude_of(const Analysis& analysis, std::size_t i) {
  const Eigen::MatrixXd& history = analysis.histories[i];
  return history.size() > 0 ? history.cwiseAbs().maxCoeff()
                            : std::abs(analysis.reductions[i].value);
}

void judge(const JudgedScene& scene, const Coarseness& coarseness, const References& references,
           std::vector<JudgedValue>& judged) {
  const ProblemFile file = refined(scene.file, {coarseness.step, coarseness.elements});
  const std::unique_ptr<Analysis> analysis = analyze(file, scene.x);
  const RefinedRun& in_time = references.in_time.at(coarseness.elements);
  if (in_time.has_failed()) return;
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const Resolution found = judge_resolution({file, scene.x, *analysis, monitors});
  for (std::size_t i = 0; i < found.bars.size(); ++i) {
    if (!found.bars[i]) continue;
    const auto index = static_cast<Eigen::Index>(i);
    const double value = analysis->reductions[i].value, reference = references.finest.values(index);
    JudgedValue one;
    one.scene = scene.name;
    one.response = analysis->responses[i].name;
    one.what = file.responses[i].what;
    one.over_time = file.responses[i].over_time;
    one.coarseness = coarseness;
    one.value = value;
    one.magnitude = magnitude_of(*analysis, i);
    one.bar = *found.bars[i];
    one.error = reference - value;
    one.step_error = in_time.values(index) - value;
    one.reference_error = reference - references.coarser.values(index);
    judged.push_back(one);
  }
}

}  // namespace

bool JudgedValue::is_resolved() const {
  return bar.is_resolved() && std::isfinite(bar.bound());
}

bool JudgedValue::is_exact() const {
  return std::abs(error) <= round_off * magnitude;
}

bool JudgedValue::is_covered() const {
  return is_exact() || std::abs(error) <= bar.bound();
}

double JudgedValue::ratio() const {
  return bar.bound() / std::abs(error);
}

std::vector<JudgedValue> judged_values(const JudgedScene& scene) {
  std::vector<JudgedValue> judged;
  const References references(scene);
  if (references.finest.has_failed() || references.coarser.has_failed()) return judged;
  for (const Coarseness& coarseness : scene.coarseness) {
    try {
      judge(scene, coarseness, references, judged);
    } catch (const SimulationError&) {  // too coarse to run
    }
  }
  return judged;
}

}  // namespace pleuel::test
