#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/make_responses.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

constexpr double small_correction = 0.01;
/// Of velocities that change alike the first one is told, whatever their round-off.
constexpr double just_larger = 1.0 + 1e-6;

using Velocity = std::array<Number, 3>;

bool is_given(const Velocity& velocity, const Design<double>& design) {
  return std::ranges::any_of(velocity,
                             [&](const Number& number) { return resolve(number, design) != 0.0; });
}

class InitialMotion {
 public:
  explicit InitialMotion(const TrustedRun& run)
      : run_(run),
        design_(run.x.begin(), run.x.end()),
        asked_(run.analysis.model.mechanism.guess),
        start_(run.analysis.trajectory.state_at(0)) {}

  std::vector<Finding> find() {
    for (const Body& body : run_.problem.scene.bodies) {
      const BodyFrame& frame = run_.analysis.model.parts(body.name).front()->frame;
      const int first = frame.offset, turn = frame.offset + frame.translations();
      if (is_given(body.velocity, design_)) {
        compare(body.name, "velocity", "m/s", first, frame.translations());
      }
      if (is_given(body.angular_velocity, design_)) {
        compare(body.name, "angular velocity", "rad/s", turn, frame.rotations());
      }
      if (!body.initial_deflections.empty()) compare_deflections(body.name);
      for (std::size_t i = 0; i < body.initial_deflections.size(); ++i) compare_place(body, i);
    }
    compare_with_impulse();
    return std::move(findings_);
  }

 private:
  /// What joints and drives do not determine starts as close as possible to what the file gives: by a
  /// measure of lengths and angles, which is none of nature. An impulse that makes the same velocities
  /// fit, on bodies that do not deform, changes kinetic energy the least. Where both agree, or nothing
  /// has to change, the start is what the file says.
  void compare_with_impulse() {
    const Eigen::VectorXd change = start_.v - asked_.v;
    if (change.isZero(0.0) || !findings_.empty()) return;
    const Eigen::VectorXd other = impulsive_change(change);
    if (other.size() == 0) return;
    const Eigen::VectorXd& scale = run_.analysis.model.mechanism.scale;
    const double largest = largest_rate();
    Worst worst;
    for (const BodyModel& body : run_.analysis.model.bodies) {
      const auto see = [&](const char* what, const char* unit, int first, int size) {
        const auto of = [&](const Eigen::VectorXd& all) { return all.segment(first, size); };
        const double difference = of(other).cwiseQuotient(of(scale)).norm();
        const double least = std::max(just_larger * worst.difference, small_correction * largest);
        if (size == 0 || difference <= least) return;
        worst = {difference, body.name,           what,
                 unit,       of(start_.v).norm(), (of(start_.v) + of(other)).norm()};
      };
      const BodyFrame& frame = body.frame;
      see("velocity", "m/s", frame.offset, frame.translations());
      see("angular velocity", "rad/s", frame.offset + frame.translations(), frame.rotations());
    }
    if (worst.body.empty()) return;
    findings_.push_back(
        {fmt::format(
             "drives and joints demand velocities at t = 0 that the file does not give, and "
             "leave some of them open: the {1} of \"{0}\" starts as {3:.4g} {2}, where a "
             "sudden start would make it {4:.4g} {2}. Let the drives begin at rest, or give "
             "every body that moves at t = 0 both velocities of its frame.",
             worst.body, worst.what, worst.unit, worst.found, worst.impulsive),
         true});
  }

  /// Of some instants, relative to the scales of coordinates.
  double largest_rate() const {
    constexpr int instants = 20;
    const Trajectory& trajectory = run_.analysis.trajectory;
    const Eigen::VectorXd& scale = run_.analysis.model.mechanism.scale;
    double largest = 0.0;
    for (int i = 0; i <= instants; ++i) {
      const State state = trajectory.state_at(i * trajectory.steps() / instants);
      largest = std::max(largest, state.v.cwiseQuotient(scale).lpNorm<Eigen::Infinity>());
    }
    return largest;
  }

  struct Worst {
    double difference = 0.0;
    std::string body{};
    const char *what = "", *unit = "";
    double found = 0.0, impulsive = 0.0;
  };

  /// What an impulse would change beside: δ with Φ_q δ = 0 and least (c + δ)ᵀ M (c + δ). Empty where
  /// it is not determined, as without mass.
  Eigen::VectorXd impulsive_change(const Eigen::VectorXd& change) const {
    constexpr double stiff = 1e8;  // of elastic coordinates, against their mass
    const Mechanism& mechanism = run_.analysis.model.mechanism;
    System& system = *mechanism.system;
    const int n = system.coordinates();
    System::Matrix matrix = system.make_matrix(), mass = matrix;
    system.tangent(start_, {.q = 1.0}, ConstraintLevel::position, matrix);
    system.tangent(start_, {.a = 1.0}, ConstraintLevel::position, mass);
    for (int col = 0; col < n; ++col) {
      for (int k = matrix.outerIndexPtr()[col]; k < matrix.outerIndexPtr()[col + 1]; ++k) {
        if (matrix.innerIndexPtr()[k] < n) matrix.valuePtr()[k] = mass.valuePtr()[k];
      }
    }
    for (const int i : mechanism.elastic) matrix.coeffRef(i, i) *= stiff;
    LinearSolver solver(matrix, mechanism.elastic);
    if (!solver.factorize(matrix)) return {};
    Eigen::VectorXd answer = Eigen::VectorXd::Zero(system.size());
    answer.head(n) = -(matrix.topLeftCorner(n, n) * change);
    solver.solve(answer);
    if (!answer.allFinite() || !solver.is_accurate()) return {};
    return answer.head(n);
  }

  void compare_deflections(const std::string& body) {
    const int first = run_.analysis.model.parts(body).front()->elastic_offset();
    for (const BentStart& bent : run_.analysis.model.mechanism.bent_starts) {
      if (bent.offset != first) continue;
      compare_deflections(body, "deflection", "m", bent, start_.q, asked_.q);
      compare_deflections(body, "rate of deflection", "m/s", bent, start_.v, asked_.v);
    }
  }

  /// Of the displacements that are given the one that is off most.
  void compare_deflections(const std::string& body, const char* what, const char* unit,
                           const BentStart& bent, const Eigen::VectorXd& found,
                           const Eigen::VectorXd& asked) {
    const auto given = [&](const Eigen::VectorXd& all) -> Eigen::VectorXd {
      return bent.rows * all.segment(bent.offset, bent.rows.cols());
    };
    const Eigen::VectorXd is = given(found), should = given(asked);
    Eigen::Index worst = 0;
    const double change = (is - should).cwiseAbs().maxCoeff(&worst);
    if (!(change > small_correction * should.lpNorm<Eigen::Infinity>())) return;
    findings_.push_back(
        {fmt::format("the initial {0} {1} of \"{2}\" is {3:.4g} {4} instead of the {5:.4g} {4} of "
                     "the file: joints and drives hold the body in another shape.",
                     what, worst, body, is(worst), unit, should(worst)),
         true});
  }

  /// A frame that is the tangent at an end turns with the bent beam where joints hold both ends.
  void compare_place(const Body& body, std::size_t i) {
    const InitialDeflection& one = body.initial_deflections[i];
    const double displacement = resolve(one.displacement, design_);
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || displacement == 0.0) return;
    if (beam->frame != ReferenceCondition::tangent &&
        beam->frame != ReferenceCondition::tangent_end) {
      return;
    }
    const Eigen::Vector3d from = resolve_point(beam->from, design_),
                          axis = resolve_point(beam->to, design_) - from,
                          at = resolve_point(one.at, design_);
    const double share = std::clamp((at - from).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    const double small = small_correction * std::abs(displacement);
    const double moved = moved_along(body.name, one, share, at);
    if (std::abs(moved - displacement) <= small) return;
    for (const double end : {0.0, 1.0}) {
      if (std::abs(moved_along(body.name, one, end, from + end * axis)) > small) return;
    }
    findings_.push_back(
        {fmt::format("the initial deflection {} of \"{}\" moves its place by {:.4g} m from where "
                     "it is drawn, not by {:.4g} m: it counts against the body frame, which is the "
                     "tangent at an end and turns with the bent beam. With \"frame\": \"chord\" "
                     "it counts from the line between the ends.",
                     i, body.name, moved, displacement),
         false});
  }

  /// How far a place of a beam starts from a point, along the direction of a deflection.
  double moved_along(const std::string& body, const InitialDeflection& one, double share,
                     const Eigen::Vector3d& drawn) const {
    const ResponseSettings settings{"place",
                                    PointMotionResponse{{body, share}, {.along = one.direction}}};
    const std::vector<Response> responses = make_responses({settings}, run_.analysis.model);
    Signal& signal = *responses.front().history()->signal;
    Eigen::VectorXd value(signal.channels());
    signal.observe(start_, value);
    return value(0) - to_vector(one.direction).dot(drawn);
  }

  void compare(const std::string& body, const char* what, const char* unit, int offset, int size) {
    const Eigen::VectorXd asked = asked_.v.segment(offset, size);
    const Eigen::VectorXd found = start_.v.segment(offset, size);
    if (!((found - asked).norm() > small_correction * asked.norm())) return;
    const bool is_turned = std::abs(found.norm() - asked.norm()) <= small_correction * asked.norm();
    findings_.push_back(
        {fmt::format(
             "the initial {0} of \"{1}\" is {2:.4g} {3}{4} instead of the {5:.4g} {3} of the "
             "file, as joints, drives and elastic bodies at rest demand it. Give every body "
             "that moves at t = 0 both velocities of its frame, so that they fit all joints.",
             what, body, found.norm(), unit, is_turned ? " in another direction" : "",
             asked.norm()),
         true});
  }

  const TrustedRun& run_;
  Design<double> design_;
  const State& asked_;
  State start_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> check_initial_motion(const TrustedRun& run) {
  // A motion that repeats itself is not told how it begins.
  if (run.analysis.trajectory.periodic) return {};
  return InitialMotion(run).find();
}

}  // namespace pleuel
