#include "core/scene/body_rules.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/body_places.hpp"
#include "core/scene/reading/variable_reader.hpp"

namespace pleuel {

namespace {

/// Of a dimension: see find_impossible().
constexpr double design_tolerance = 1e-3;
/// Of the sum of the moments of inertia: numbers of three digits.
constexpr double inertia_tolerance = 1e-3;
/// Moments smaller than this share of their sum are not given.
constexpr double not_given = 1e-9;
/// Variables of an inertia whose bounds are looked at: 2ⁿ corners.
constexpr std::size_t most_corners = 10;

struct RulesOfSection {
  using Rules = std::vector<SectionRule>;
  Rules operator()(const RectangleSection&) const { return {}; }
  Rules operator()(const CircleSection&) const { return {}; }
  Rules operator()(const EllipseSection&) const { return {}; }
  Rules operator()(const GeneralSection&) const { return {}; }
  Rules operator()(const TubeSection& tube) const {
    return {{"thickness", tube.thickness, "the radius", tube.outer_diameter, 0.5, " of the tube"}};
  }
  Rules operator()(const BoxSection& box) const {
    return {{"thickness", box.thickness, "half the width", box.width, 0.5, " of the box"},
            {"thickness", box.thickness, "half the height", box.height, 0.5, " of the box"}};
  }
  /// The torsion constant of an I is known up to a web of three times the flange.
  Rules operator()(const ISection& i) const {
    return {{"flange_thickness", i.flange_thickness, "half the height", i.height, 0.5, ""},
            {"web_thickness", i.web_thickness, "the width", i.width, 1.0, ""},
            {"web_thickness", i.web_thickness, "three times the flange thickness",
             i.flange_thickness, 3.0, ""}};
  }
};

Eigen::Vector3d principal_moments(const RigidBody& body, const Design<double>& design) {
  const auto entry = [&](std::size_t i) { return resolve(body.inertia[i], design); };
  Eigen::Matrix3d inertia;
  inertia << entry(0), entry(3), entry(4), entry(3), entry(1), entry(5), entry(4), entry(5),
      entry(2);
  return symmetric_eigenvalues(inertia);
}

/// Coefficients of size − share · limit at a design, by variable.
std::map<int, double> coefficients_of(const SectionRule& rule, const Design<double>& design) {
  std::map<int, double> coefficients;
  for (const int variable : rule.size.variables()) {
    coefficients[variable] += derivative_by(variable, rule.size, design);
  }
  for (const int variable : rule.of.variables()) {
    coefficients[variable] -= rule.share * derivative_by(variable, rule.of, design);
  }
  return coefficients;
}

/// What can be done about a rule that bounds do not keep.
std::string remedy(const SectionRule& rule, const std::string& terms) {
  if (rule.size.expression || rule.of.expression) {
    return "other bounds, or a constraint on a response of type \"expression\"";
  }
  return fmt::format("other bounds, or a constraint {{\"linear\": {{{}}}, \"upper\": {:g}}}", terms,
                     rule.share * rule.of.constant - rule.size.constant);
}

class Corners {
 public:
  explicit Corners(const ProblemFile& problem)
      : problem_(problem), start_(start_values(problem.variables)) {}

  std::vector<std::string> find() && {
    for (const Body& body : problem_.scene.bodies) {
      if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
        for (const Segment& segment : beam->segments) {
          for (const SectionRule& rule : section_rules(segment.section)) look_at(body, rule);
        }
      } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
        look_at(body, *rigid);
      }
    }
    return std::move(sentences_);
  }

 private:
  const DesignVariable& variable(int index) const { return problem_.variables[index]; }

  /// The rule is linear (or taken to be, of an expression): it is broken most where each variable is
  /// at one certain bound.
  void look_at(const Body& body, const SectionRule& rule) {
    const std::map<int, double> coefficients = coefficients_of(rule, start_);
    Corner corner;
    for (const auto& [index, coefficient] : coefficients) {
      corner[index] = coefficient > 0.0 ? variable(index).upper : variable(index).lower;
    }
    const auto broken = complaint(rule, at(corner), design_tolerance);
    if (!broken || is_excluded(corner)) return;
    std::string terms;
    for (const auto& [index, coefficient] : coefficients) {
      if (coefficient == 0.0) continue;
      terms += fmt::format("{}\"{}\": {:g}", terms.empty() ? "" : ", ", variable(index).name,
                           coefficient);
    }
    add(body, "section's " + std::string(rule.key), *broken, corner, remedy(rule, terms));
  }

  void look_at(const Body& body, const RigidBody& rigid) {
    std::vector<int> bound;
    for (const Number& number : rigid.inertia) {
      for (const int of : number.variables()) {
        if (std::ranges::find(bound, of) == bound.end()) bound.push_back(of);
      }
    }
    if (bound.size() > most_corners) bound.resize(most_corners);
    for (unsigned bits = 0; bits < (1U << bound.size()); ++bits) {
      Corner corner;
      for (std::size_t i = 0; i < bound.size(); ++i) {
        const DesignVariable& of = variable(bound[i]);
        corner[bound[i]] = (bits >> i) % 2 == 1 ? of.upper : of.lower;
      }
      const auto broken = inertia_complaint(rigid, at(corner));
      if (!broken || is_excluded(corner)) continue;
      add(body, "inertia", *broken, corner, "other bounds");
      return;
    }
  }

  using Corner = std::map<int, double>;  ///< by variable

  Design<double> at(const Corner& corner) const {
    Design<double> design = start_;
    for (const auto& [index, value] : corner) design[index] = value;
    return design;
  }

  /// Whether a linear constraint cannot hold there, whatever the other variables are.
  bool is_excluded(const Corner& corner) const {
    const auto excludes = [&](const ConstraintSettings& constraint) {
      double least = 0.0, most = 0.0;
      for (const auto& [index, coefficient] : constraint.linear) {
        const auto fixed = corner.find(index);
        const double one =
            coefficient * (fixed == corner.end() ? variable(index).lower : fixed->second);
        const double other =
            coefficient * (fixed == corner.end() ? variable(index).upper : fixed->second);
        least += std::min(one, other);
        most += std::max(one, other);
      }
      return (constraint.upper && least > *constraint.upper) ||
             (constraint.lower && most < *constraint.lower);
    };
    return std::ranges::any_of(problem_.constraints, [&](const ConstraintSettings& constraint) {
      return !constraint.linear.empty() && excludes(constraint);
    });
  }

  void add(const Body& body, const std::string& what, const std::string& broken,
           const Corner& corner, const std::string& remedy) {
    std::string place;
    for (const auto& [index, value] : corner) {
      place += fmt::format("{}{} = {:g}", place.empty() ? "" : ", ", variable(index).name, value);
    }
    sentences_.push_back(
        fmt::format("the bounds allow an impossible body \"{}\" (its {} {}, at {}); such designs "
                    "cannot be evaluated: give {}",
                    body.name, what, broken, place, remedy));
  }

  const ProblemFile& problem_;
  Design<double> start_;
  std::vector<std::string> sentences_;
};

}  // namespace

std::vector<SectionRule> section_rules(const Section& section) {
  return std::visit(RulesOfSection{}, section);
}

std::optional<std::string> complaint(const SectionRule& rule, const Design<double>& design,
                                     double tolerance) {
  const double value = resolve(rule.size, design), limit = rule.share * resolve(rule.of, design);
  if (value <= limit * (1.0 + tolerance)) return std::nullopt;
  return fmt::format("must not exceed {} {:g} [m]{}, got {:g}", rule.limit, limit, rule.owner,
                     value);
}

std::optional<std::string> inertia_complaint(const RigidBody& body, const Design<double>& design) {
  const Eigen::Vector3d moments = principal_moments(body, design);  // in increasing order
  const double sum = moments.cwiseAbs().sum();
  if (moments(0) < -not_given * sum) {
    return "must have no negative principal moment (xx, yy, zz, xy, xz, yz)";
  }
  const bool about_one_axis = moments(1) <= not_given * sum;
  if (about_one_axis || moments(2) <= moments(0) + moments(1) + inertia_tolerance * sum) {
    return std::nullopt;
  }
  return fmt::format(
      "must have no principal moment above the sum of the other two ({:g} > {:g} + {:g} kg m^2)",
      moments(2), moments(0), moments(1));
}

std::optional<std::string> find_impossible(const Body& body, const Design<double>& design) {
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    for (const Segment& segment : beam->segments) {
      for (const SectionRule& rule : section_rules(segment.section)) {
        const auto broken = complaint(rule, design, design_tolerance);
        if (broken) return fmt::format("its section's {} {}", rule.key, *broken);
      }
    }
  } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
    const auto broken = inertia_complaint(*rigid, design);
    if (broken) return "its inertia " + *broken;
  }
  return std::nullopt;
}

std::vector<std::string> impossible_corners(const ProblemFile& problem) {
  std::vector<std::string> sentences;
  for (const ProblemFile* one : simulated_problems(problem)) {
    for (std::string& sentence : Corners(*one).find()) {
      const bool is_known = std::ranges::find(sentences, sentence) != sentences.end();
      if (!is_known) sentences.push_back(std::move(sentence));
    }
  }
  return sentences;
}

std::vector<Eigen::Vector3d> bound_points(const Scene& scene, const Design<double>& design) {
  std::vector<Eigen::Vector3d> points;
  const auto add = [&](const Point& point, const PointKey&) {
    if (is_bound(point)) points.push_back(resolve_point(point, design));
  };
  for (const Body& body : scene.bodies) visit_body_points(body, add);
  for (const PlacedPoint& placed : placed_points(scene)) add(*placed.point, {});
  return points;
}

}  // namespace pleuel
