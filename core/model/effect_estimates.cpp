#include "core/model/effect_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/integration/simulate.hpp"
#include "core/model/divided_beams.hpp"
#include "core/model/model.hpp"
#include "core/start/redundancy.hpp"

namespace pleuel {

namespace {

constexpr int most_steps = 1000;
constexpr double sudden = 2.0;

Design<double> start_values(const ProblemFile& problem) {
  Design<double> values;
  for (const DesignVariable& variable : problem.variables) values.push_back(variable.start);
  return values;
}

/// Largest deformations of one beam over time.
struct Deformation {
  double displacement = 0.0, axial = 0.0, twist = 0.0;  ///< [m]; twist times half depth
  double acceleration = 0.0, axial_acceleration = 0.0, twist_acceleration = 0.0;  ///< [m/s²]
  double axial_force = 0.0;                                                       ///< [N]
};

/// Quasi-static deformation of an elastic beam by the loads of the rigid motion.
class QuasiStaticBeam {
 public:
  explicit QuasiStaticBeam(const BodyModel& body)
      : body_(body), stiffness_(dense_matrix(body.invariants.pattern, body.invariants.stiffness)) {
    for (const auto& element : body.beam.elements) {
      for (const auto& point : element.section.points) {
        depth_ = std::max({depth_, std::abs(point.y), std::abs(point.z)});
      }
    }
  }

  /// @param forces  elastic rows of the residual with undeformed bodies
  void add(const Eigen::VectorXd& forces, double step) {
    const Eigen::VectorXd q = -stiffness_.solve(forces);
    Nodal d = body_.places.displacements(q);
    measure(d, largest_.displacement, largest_.axial, largest_.twist);
    note_axial_force(d);
    if (count_ >= 2) {
      const Nodal rate = (d - 2.0 * last_ + before_) / (step * step);
      measure(rate, largest_.acceleration, largest_.axial_acceleration,
              largest_.twist_acceleration);
    }
    before_ = last_;
    last_ = std::move(d);
    ++count_;
  }

  const Deformation& largest() const { return largest_; }

 private:
  /// u v w θx θy θz, a column each node.
  using Nodal = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  void measure(const Nodal& d, double& all, double& axial, double& twist) const {
    const double along = d.row(0).lpNorm<Eigen::Infinity>();
    const double turned = d.row(3).lpNorm<Eigen::Infinity>() * depth_;
    all = std::max({all, d.middleRows(1, 2).lpNorm<Eigen::Infinity>(), along, turned});
    axial = std::max(axial, along);
    twist = std::max(twist, turned);
  }

  void note_axial_force(const Nodal& d) {
    for (int e = 0; e + 1 < d.cols(); ++e) {
      const auto& element = body_.beam.elements[e];
      const double force =
          element.young * element.section.area / element.length * (d(0, e + 1) - d(0, e));
      largest_.axial_force = std::max(largest_.axial_force, std::abs(force));
    }
  }

  const BodyModel& body_;
  Cholesky stiffness_;
  double depth_ = 0.0;
  Nodal last_, before_;
  int count_ = 0;
  Deformation largest_;
};

/// The smallest Euler load of the sections, about the axis about which it can bend.
double euler_load(const BodyModel& body, const BeamBody& beam) {
  double stiffness = std::numeric_limits<double>::infinity();
  const NodalFlags bends = [&] {
    NodalFlags flags{};
    for (int node = 0; node < body.coordinates.node_count(); ++node) {
      for (int i = 0; i < 6; ++i) {
        if (body.coordinates.index(node, i) >= 0) flags[i] = true;
      }
    }
    return flags;
  }();
  for (const auto& element : body.beam.elements) {
    if (bends[5]) stiffness = std::min(stiffness, element.young * element.section.inertia_z);
    if (bends[4]) stiffness = std::min(stiffness, element.young * element.section.inertia_y);
  }
  const bool is_clamped =
      beam.frame == ReferenceCondition::tangent || beam.frame == ReferenceCondition::tangent_end;
  const double length =
      (is_clamped ? 2.0 : 1.0) * body.beam.node_position(body.beam.node_count() - 1);
  return std::numbers::pi * std::numbers::pi * stiffness / (length * length);
}

double rotary_share(const BodyModel& body) {
  const double length = body.beam.node_position(body.beam.node_count() - 1);
  double share = 0.0;
  for (const auto& element : body.beam.elements) {
    const auto& section = element.section;
    share = std::max(share, std::max(section.inertia_y, section.inertia_z) / section.area);
  }
  return std::numbers::pi * std::numbers::pi * share / (length * length);
}

/// What is made from section forces, which needs all strain of the body.
bool is_of_forces(const ResponseSettings& response) {
  return stress_places(response) || response.is<SectionForceResponse>() ||
         response.is(EnergyKind::elastic);
}

bool asks_for(const ProblemFile& problem, const std::string& body,
              bool (*is_meant)(const ResponseSettings&)) {
  return std::ranges::any_of(problem.responses, [&](const ResponseSettings& response) {
    if (!is_meant(response)) return false;
    const std::vector<std::string> bodies = bodies_of(response);
    // Without one: frequencies of the whole mechanism.
    return bodies.empty() || std::ranges::find(bodies, body) != bodies.end();
  });
}

/// The elastic model moved like the rigid one.
class Estimation {
 public:
  explicit Estimation(const ProblemFile& problem)
      : problem_(problem),
        start_(start_values(problem)),
        elastic_(build(EffectChoice::automatic)),
        rigid_(build(EffectChoice::off)) {}

  std::map<std::string, BeamEstimates> run() {
    const Trajectory trajectory = simulate(rigid_.mechanism, options());
    std::vector<QuasiStaticBeam> beams;
    std::vector<const BodyModel*> bodies;
    for (const BodyModel& body : elastic_.bodies) {
      if (!body.is_beam() || body.elastic_size() == 0) continue;
      beams.emplace_back(body);
      bodies.push_back(&body);
    }
    System& system = *elastic_.mechanism.system;
    State rigid, state(system.coordinates(), system.multipliers());
    Eigen::VectorXd residual;
    double acceleration = 0.0;
    std::optional<LeastNorm> norm;
    if (!rigid_.mechanism.system->left_out().empty()) norm.emplace(rigid_.mechanism);
    for (int step = 0; step <= trajectory.steps(); ++step) {
      trajectory.states->load(step, rigid);
      if (norm) {
        norm->set(rigid);
        rigid.lambda = norm->apply(rigid.lambda);
      }
      acceleration = std::max(acceleration, copy(rigid, state));
      system.residual(state, ConstraintLevel::position, residual);
      for (std::size_t i = 0; i < beams.size(); ++i) {
        beams[i].add(residual.segment(bodies[i]->elastic_offset(), bodies[i]->elastic_size()),
                     trajectory.scheme.step);
      }
    }
    std::map<std::string, BeamEstimates> estimates;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      estimates[bodies[i]->name] = estimates_of(*bodies[i], beams[i].largest(), acceleration);
    }
    return estimates;
  }

 private:
  Model build(EffectChoice elasticity) const {
    EffectSettings settings = problem_.effects;
    settings.decisions = {};
    settings.elasticity = elasticity;
    return build_model(without_divisions(problem_.scene), settings, start_, start_, std::nullopt);
  }

  SimulationOptions options() const {
    const SimulationSettings& settings = problem_.simulation;
    SimulationOptions options;
    options.end_time = settings.end_time;
    options.step = std::max(settings.step, settings.end_time / most_steps);
    options.spectral_radius = settings.spectral_radius;
    return options;
  }

  /// @returns the largest acceleration of a frame's origin or of a member's far end [m/s²]
  double copy(const State& rigid, State& state) const {
    double largest = 0.0;
    state.time = rigid.time;
    state.lambda = rigid.lambda;
    for (std::size_t i = 0; i < elastic_.bodies.size(); ++i) {
      const BodyFrame& from = rigid_.bodies[i].frame;
      const BodyFrame& to = elastic_.bodies[i].frame;
      state.q.segment(to.offset, to.size()) = rigid.q.segment(from.offset, from.size());
      state.v.segment(to.offset, to.size()) = rigid.v.segment(from.offset, from.size());
      state.a.segment(to.offset, to.size()) = rigid.a.segment(from.offset, from.size());
      const auto a = rigid.a.segment(from.offset, from.size());
      const auto v = rigid.v.segment(from.offset, from.size());
      const double length = length_of(elastic_.bodies[i]);
      const double turning =
          a.tail(from.rotations()).norm() + v.tail(from.rotations()).squaredNorm();
      largest = std::max(largest, a.head(from.translations()).norm() + turning * length);
    }
    return largest;
  }

  static double length_of(const BodyModel& body) {
    return body.is_beam() ? body.beam.node_position(body.beam.node_count() - 1) : 0.0;
  }

  BeamEstimates estimates_of(const BodyModel& body, const Deformation& d,
                             double acceleration) const {
    const auto& beam = std::get<BeamBody>(find_named(problem_.scene.bodies, body.name)->shape);
    // The scale of translations is the size of the mechanism.
    const double size = elastic_.mechanism.scale(body.frame.offset);
    const auto change = [&](double displacement, double rate) {
      return sudden * std::max(displacement / size, acceleration > 0.0 ? rate / acceleration : 0.0);
    };
    constexpr double always = std::numeric_limits<double>::infinity();
    BeamEstimates estimates;
    estimates.elasticity = change(d.displacement, d.acceleration);
    const bool asks_for_forces = asks_for(problem_, body.name, is_of_forces);
    const bool asks_for_buckling = asks_for(problem_, body.name, [](const ResponseSettings& one) {
      return one.is<BucklingResponse, LateralBucklingResponse>();
    });
    const bool asks_for_bending = asks_for(problem_, body.name, [](const ResponseSettings& one) {
      return one.is<DeflectionResponse, ModeResponse>();
    });
    if (asks_for_forces || asks_for_buckling || asks_for_bending) estimates.elasticity = always;
    estimates.axial_elasticity = change(d.axial, d.axial_acceleration);
    if (asks_for_forces || asks_for_buckling) estimates.axial_elasticity = always;
    estimates.torsional_elasticity = change(d.twist, d.twist_acceleration);
    if (asks_for_forces) estimates.torsional_elasticity = always;
    if (!find_named(problem_.scene.bodies, body.name)->initial_deflections.empty()) {
      estimates.elasticity = estimates.axial_elasticity = estimates.torsional_elasticity = always;
    }
    estimates.geometric_stiffening = d.axial_force / euler_load(body, beam);
    estimates.rotary_inertia = rotary_share(body);
    return estimates;
  }

  const ProblemFile& problem_;
  Design<double> start_;
  Model elastic_, rigid_;
};

}  // namespace

std::map<std::string, BeamEstimates> estimate_effects(const ProblemFile& problem) {
  if (problem.effects.tolerance <= 0.0 || problem.effects.elasticity == EffectChoice::off) {
    return {};
  }
  try {
    return Estimation(problem).run();
  } catch (const SimulationError&) {
    return {};
  }
}

}  // namespace pleuel
