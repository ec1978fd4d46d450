#include "studies/number_prices.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/period_map.hpp"
#include "core/integration/repetition.hpp"
#include "core/model/motion_plane.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/body_rules.hpp"
#include "optimization/design/size_lists.hpp"
#include "optimization/scaling.hpp"
#include "studies/row_prices.hpp"

namespace pleuel {

namespace {

using Groups = std::vector<NumberGroup>;

constexpr const char* point_ends[] = {"/from", "/to", "/at", "/at/0", "/at/1"};

/// "…/at/1" is the second component of the point "…/at".
struct Component {
  std::string point;
  int index = 0;
};

/// Of a body, a joint or a load, or one of the two of a spring.
bool is_point(const std::string& pointer) {
  return std::any_of(std::begin(point_ends), std::end(point_ends),
                     [&](const char* end) { return pointer.ends_with(end); });
}

std::optional<Component> component_of(const SceneNumber& number) {
  const std::size_t slash = number.pointer.rfind('/');
  const std::string point = number.pointer.substr(0, slash);
  if (!is_point(point)) return std::nullopt;
  return Component{point, std::stoi(number.pointer.substr(slash + 1))};
}

/// Equal for points at one place.
std::string place_text(double x, double y, double z) {
  const auto rounded = [](double value) { return value == 0.0 ? 0.0 : value; };  // no −0
  return fmt::format("{:.12g} {:.12g} {:.12g}", rounded(x), rounded(y), rounded(z));
}

/// The coordinates of points; one that is not fixed is missing.
using Coordinates = std::map<std::string, std::array<std::optional<double>, 3>>;

Coordinates coordinates_of(const std::vector<SceneNumber>& numbers) {
  Coordinates all;
  for (const SceneNumber& number : numbers) {
    if (const auto component = component_of(number)) {
      all[component->point][component->index] = number.value;
    }
  }
  return all;
}

bool leaves_plane(const Component& component, const std::optional<MotionPlane>& plane) {
  return plane && std::abs(plane->normal(component.index)) > 1e-12;
}

/// @param taken  places of points that variables move: what is there cannot be moved by itself
Groups grouped(const std::vector<SceneNumber>& numbers, const std::optional<MotionPlane>& plane,
               const std::set<std::string>& taken) {
  const Coordinates coordinates = coordinates_of(numbers);
  Groups groups;
  std::map<std::string, std::size_t> group_of_place;
  for (const SceneNumber& number : numbers) {
    const auto component = component_of(number);
    if (!component) {
      if (number.value != 0.0) groups.push_back({number.pointer, {number.pointer}});
      continue;
    }
    const auto& [x, y, z] = coordinates.at(component->point);
    const std::string place = x && y && z ? place_text(*x, *y, *z) : component->point;
    if (leaves_plane(*component, plane) || taken.contains(place)) continue;
    const std::string key = fmt::format("{} {}", place, component->index);
    const auto [found, is_new] = group_of_place.try_emplace(key, groups.size());
    if (is_new) groups.push_back({number.pointer, {}});
    groups[found->second].pointers.push_back(number.pointer);
  }
  return groups;
}

bool can_be_bound(const ProblemText& text, const Groups& groups) {
  try {
    bind_numbers(text, groups);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Those that variables can stand for, by halves: mostly all of them, and one reading will do.
Groups bindable(const ProblemText& text, const Groups& groups) {
  if (groups.empty() || can_be_bound(text, groups)) return groups;
  if (groups.size() == 1) return {};
  const auto middle = groups.begin() + static_cast<std::ptrdiff_t>(groups.size() / 2);
  Groups kept = bindable(text, Groups(groups.begin(), middle));
  const Groups rest = bindable(text, Groups(middle, groups.end()));
  kept.insert(kept.end(), rest.begin(), rest.end());
  return kept;
}

/// What is left of the terms of a price where they cancel, by the round-off of gradients.
constexpr double round_off = 1e-7;
/// Of the objective: a percent of a number that changes less of it has no price.
constexpr double least_change = 1e-10;
/// Of the magnitude of a limit: what counts as reaching it.
constexpr double at_limit = 1e-6;

/// The least change of the free variables, in their magnitudes, that keeps the rows which decide
/// where they are. The whole answer if as many rows decide as there are free variables.
/// @param change  of the values of the rows, at the design as it is
Eigen::VectorXd answer_to(const Eigen::VectorXd& change, const RowPrices& optimum) {
  const Eigen::VectorXd s = local_scales(optimum.at.rows, optimum.at.x);
  std::vector<Eigen::Index> free, deciding;
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    const bool is_fixed = optimum.at.rows.variables()[i].is_fixed();
    if (optimum.bound_multipliers(i) == 0.0 && !is_fixed) free.push_back(i);
  }
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (optimum.multipliers(i) != 0.0) deciding.push_back(i);
  }
  Eigen::VectorXd step = Eigen::VectorXd::Zero(s.size());
  if (free.empty() || deciding.empty()) return step;
  const Eigen::MatrixXd scaled = optimum.at.evaluation.constraint_jacobian * s.asDiagonal();
  const Eigen::VectorXd magnitudes = optimum.scales(deciding).cwiseInverse();
  const Eigen::MatrixXd matrix = magnitudes.asDiagonal() * scaled(deciding, free);
  const Eigen::VectorXd right = -magnitudes.cwiseProduct(change(deciding));
  const Eigen::VectorXd found = least_norm_solution(matrix, right);
  for (std::size_t k = 0; k < free.size(); ++k) step(free[k]) = s(free[k]) * found(k);
  return step;
}

/// The first limit beyond those that decide now which a change of the rows makes a design break
/// that answers it; empty if there is none. A row of a constraint that decides already is another of
/// its peaks.
std::string next_limit(const Eigen::VectorXd& change, const RowPrices& optimum) {
  const Eigen::VectorXd step = answer_to(change, optimum);
  const Evaluation& evaluation = optimum.at.evaluation;
  const Eigen::VectorXd values =
      evaluation.constraints + change + evaluation.constraint_jacobian * step;
  const std::vector<Constraint>& limits = optimum.at.rows.constraints();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const bool decides = optimum.multipliers(i) != 0.0;
    if (decides || !(limits[i].excess(values(i)) > at_limit * optimum.scales(i))) continue;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      const bool is_same = limits[k].name == limits[i].name;
      if (is_same && optimum.multipliers(k) != 0.0) return "another peak of " + limits[i].name;
    }
    return limits[i].name;
  }
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const Variable& variable = optimum.at.rows.variables()[i];
    const double value = optimum.at.x(i) + step(i);
    const double room = at_limit * std::abs(value);
    const bool is_free = optimum.bound_multipliers(i) == 0.0 && !variable.is_fixed();
    const bool is_outside = value > variable.upper + room || value < variable.lower - room;
    if (is_free && is_outside) return variable.name;
  }
  return "";
}

/// Prices of variables from the gradient of their problem, at the multipliers of the optimum.
struct Pricing {
  const RowPrices& optimum;
  const Evaluation& evaluation;

  void set(Eigen::Index variable, NumberPrice& price) const {
    const double direct = evaluation.objective_gradient(variable);
    const Eigen::VectorXd slopes = evaluation.constraint_jacobian.col(variable);
    const Eigen::VectorXd through = optimum.multipliers.cwiseProduct(slopes);
    const double terms = std::abs(direct) + through.cwiseAbs().sum();
    const double sum = direct + through.sum();
    const double change = price.value == 0.0 ? sum : 0.01 * price.value * sum;
    const bool is_noise = std::abs(sum) <= round_off * terms ||
                          std::abs(change) <= least_change * std::abs(evaluation.objective);
    price.per_unit = is_noise ? 0.0 : sum;
    price.next_limit = next_limit(0.01 * price.value * slopes, optimum);
  }
};

/// The problem with all numbers as variables; decisions that a measurement made stay.
ProblemFile with_numbers(const ProblemText& text, const ProblemFile& problem,
                         const std::vector<NumberGroup>& groups) {
  ProblemFile extended = bind_numbers(text, groups);
  extended.effects = problem.effects;
  extended.sensitivity = problem.sensitivity;
  return extended;
}

Eigen::VectorXd extended_design(const ProblemFile& extended, const Eigen::VectorXd& x) {
  Eigen::VectorXd design = start_design(extended);
  design.head(x.size()) = x;
  return design;
}

/// Sizes that are chosen from lists stay as they are.
ProblemFile with_sizes_at(ProblemFile problem, const Eigen::VectorXd& x) {
  problem = with_sizes(std::move(problem), x);
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    if (problem.variables[i].has_choices()) problem.variables[i].start = x(i);
  }
  return problem;
}

/// Without the numbers that set the period of a motion that repeats itself, as the speed of its
/// drive.
PricedNumbers without_periods(const ProblemText& text, const ProblemFile& problem,
                              const Eigen::VectorXd& x, PricedNumbers numbers) {
  std::vector<NumberGroup>& groups = numbers.groups;
  const ProblemFile extended = with_numbers(text, problem, groups);
  const auto analysis = analyze(extended, extended_design(extended, x));
  const Trajectory& trajectory = analysis->trajectory;
  if (!trajectory.periodic) return numbers;
  const std::vector<int> variables =
      variables_of_unrepeated_derivatives(analysis->model.mechanism, trajectory,
                                          trajectory.periodic->steps, trajectory.periodic->period);
  const int first = int_size(extended.variables) - int_size(groups);
  for (auto variable = variables.rbegin(); variable != variables.rend(); ++variable) {
    if (*variable < first) continue;
    const auto group = groups.begin() + (*variable - first);
    numbers.left_out.push_back(group->name);
    groups.erase(group);
  }
  return numbers;
}

void add_limits(const ProblemFile& problem, const RowPrices& optimum, PriceList& list) {
  const Eigen::VectorXd multipliers = optimum.at.peaks.fold_multipliers(optimum.multipliers);
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const double multiplier = multipliers(i);
    if (multiplier == 0.0) continue;
    const ConstraintSettings& constraint = problem.constraints[i];
    const bool is_upper = multiplier > 0.0;
    NumberPrice price;
    price.kind = NumberPrice::Kind::limit;
    price.name = fmt::format("/constraints/{}/{}", constraint.name, is_upper ? "upper" : "lower");
    price.pointers = {price.name};
    price.value = is_upper ? *constraint.upper : *constraint.lower;
    price.unit = unit_of(problem, constraint);
    price.per_unit = -multiplier;
    list.prices.push_back(std::move(price));
  }
}

void add_variables(const ProblemFile& problem, const RowPrices& optimum, const Pricing& pricing,
                   PriceList& list) {
  const std::vector<ShownUnit> units = variable_units(problem);
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    if (variable.has_choices()) continue;  // there is no more of it
    NumberPrice price;
    price.unit = units[i];
    if (variable.lower == variable.upper) {
      price.kind = NumberPrice::Kind::variable;
      price.name = variable.name;
      price.value = variable.lower;
      pricing.set(i, price);
    } else {
      const double multiplier = optimum.bound_multipliers(i);
      if (multiplier == 0.0) continue;
      const bool is_upper = multiplier > 0.0;
      price.kind = NumberPrice::Kind::bound;
      price.name = fmt::format("/variables/{}/{}", variable.name, is_upper ? "upper" : "lower");
      price.value = is_upper ? variable.upper : variable.lower;
      price.per_unit = -multiplier;
    }
    price.pointers = {price.name};
    list.prices.push_back(std::move(price));
  }
}

void add_numbers(const ProblemFile& extended, const std::vector<NumberGroup>& groups,
                 const Pricing& pricing, PriceList& list) {
  const std::vector<ShownUnit> units = variable_units(extended);
  const std::size_t first = extended.variables.size() - groups.size();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    NumberPrice price;
    price.name = groups[i].name;
    price.pointers = groups[i].pointers;
    price.value = extended.variables[first + i].start;
    price.unit = units[first + i];
    pricing.set(static_cast<Eigen::Index>(first + i), price);
    list.prices.push_back(std::move(price));
  }
}

}  // namespace

PricedNumbers priced_numbers(const ProblemText& text, const ProblemFile& problem) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(start.begin(), start.end());
  std::set<std::string> taken;
  for (const Eigen::Vector3d& point : bound_points(problem.scene, design)) {
    taken.insert(place_text(point.x(), point.y(), point.z()));
  }
  const PlaneAnalysis plane = find_motion_plane(problem.scene, design);
  const Groups wanted = grouped(scene_numbers(text), plane.plane, taken);
  PricedNumbers priced{bindable(text, wanted), {}};
  for (const NumberGroup& group : wanted) {
    const bool is_priced = std::ranges::any_of(
        priced.groups, [&](const NumberGroup& one) { return one.name == group.name; });
    if (!is_priced) priced.left_out.push_back(group.name);
  }
  return priced;
}

PriceList number_prices(const ProblemText& text, const ProblemFile& file, const Eigen::VectorXd& x,
                        int threads) {
  const ProblemFile problem = with_sizes_at(file, x);
  const int windows = windows_at(problem, x, threads);
  const RowPrices optimum(problem, x, windows, threads);
  PricedNumbers numbers = priced_numbers(text, problem);
  if (problem.simulation.period > 0.0) {
    numbers = without_periods(text, problem, x, std::move(numbers));
  }
  const std::vector<NumberGroup>& groups = numbers.groups;
  const ProblemFile extended = with_sizes_at(with_numbers(text, problem, groups), x);
  const DesignRows rows(extended, extended_design(extended, x), windows, threads);
  const Pricing pricing{optimum, rows.evaluation};
  PriceList list;
  list.unknown = numbers.left_out;
  const Evaluation& evaluation = optimum.at.evaluation;
  list.objective = optimum.at.peaks.fold_objective(evaluation.objective, evaluation.constraints);
  list.residual = optimum.residual;
  add_limits(problem, optimum, list);
  add_variables(problem, optimum, pricing, list);
  add_numbers(extended, groups, pricing, list);
  const double sign = problem.objective->sign();
  list.objective *= sign;
  for (NumberPrice& price : list.prices) price.per_unit *= sign;
  std::ranges::stable_sort(list.prices, [](const NumberPrice& a, const NumberPrice& b) {
    return std::abs(a.per_percent()) > std::abs(b.per_percent());
  });
  return list;
}

}  // namespace pleuel
