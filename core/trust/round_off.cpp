#include "core/trust/round_off.hpp"

#include <algorithm>
#include <complex>
#include <optional>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/make_responses.hpp"
#include "core/response/recorder.hpp"
#include "core/scene/response_parts.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Of forces and stresses: what cancels in them is as large as the whole, and Newton's method ends
/// at 1e-10.
constexpr double tiny_force = 1e-9;
/// Forces and torques that hold a motion make up for round-off of its positions, ε/h² of N steps;
/// beside the energy that is in it: N² times this, within limits.
constexpr double tiny_inertia = 2e-13, most_inertia = 1e-6;
/// Of the same section force, or stress, elsewhere in the body: what is smaller at all times vanishes
/// in truth, as at pins and free ends, and is made of the errors of elements.
constexpr double vanishing = 1e-3;
/// Of stress: a strain of round-off, against the size of the mechanism.
constexpr double tiny_strain = 1e-13;
/// Of shares of a buckling load.
constexpr double tiny_share = 1e-12;
/// Of an eigenvalue, for its real part.
constexpr double tiny_rate = 1e-9;
/// Of lengths, which are exact to the last digits.
constexpr double tiny_length = 1e-12;
/// Of lengths that rates over one step are made from.
constexpr double tiny_way = 1e-14;

/// Of a simulation, for magnitudes: what they are compared with is smaller by powers of ten.
constexpr int enough_instants = 200;

/// What a response is compared with: a share of another response of the same run.
struct Measure {
  AnyResponse what;
  double share = tiny_force;
};

double largest(const Eigen::MatrixXd& history) {
  return history.size() > 0 ? history.cwiseAbs().maxCoeff() : 0.0;
}

class RoundOff {
 public:
  explicit RoundOff(const TrustedRun& run) : run_(run), model_(run.analysis.model) {
    for (const BodyModel& body : model_.bodies) {
      if (body.frame.translations() > 0) size_ = model_.mechanism.scale(body.frame.offset);
    }
  }

  std::vector<bool> find() {
    const std::vector<ResponseSettings>& responses = run_.problem.responses;
    std::vector<std::vector<Measure>> measures;
    for (const ResponseSettings& response : responses) {
      measures.push_back(
          std::visit([&](const auto& one) { return measures_of(one); }, response.what));
    }
    const std::vector<double> measured = measure(measures);
    std::vector<bool> is_round_off(responses.size(), false);
    std::size_t next = 0;
    for (std::size_t i = 0; i < responses.size(); ++i) {
      double scale = std::max(length_scale(responses[i]), strain_scale(responses[i]));
      for (const Measure& one : measures[i]) {
        scale = std::max(scale, one.share * measured[next++]);
      }
      is_round_off[i] = run_.analysis.responses[i].mode()
                            ? is_tiny_rate(i)
                            : run_.analysis.responses[i].history() &&
                                  largest(run_.analysis.histories[i]) <= scale;
    }
    for (std::size_t i = 0; i < responses.size(); ++i) {
      if (responses[i].is<ExpressionResponse>()) is_round_off[i] = are_all(is_round_off, i);
    }
    return is_round_off;
  }

 private:
  /// Of a damped mode: whether its number is next to nothing beside its eigenvalue.
  bool is_tiny_rate(std::size_t response) const {
    if (!run_.analysis.responses[response].mode()->counts_damping()) return false;
    const std::complex<double> s =
        run_.analysis.damped_modes(run_.analysis.mechanism_modes[response]);
    return std::abs(s.real()) <= tiny_rate * std::abs(s);
  }

  /// Whether all parts of an expression are round-off.
  bool are_all(const std::vector<bool>& is_round_off, std::size_t expression) const {
    const std::vector<std::size_t> parts = parts_of(run_.problem, expression);
    return !parts.empty() &&
           std::ranges::all_of(parts, [&](std::size_t part) { return is_round_off[part]; });
  }

  /// Of a length or an angle, and of its rates.
  double length_scale(const ResponseSettings& response) const {
    constexpr int most_rates = 3;
    const Trajectory& trajectory = run_.analysis.trajectory;
    const double step = trajectory.time(trajectory.steps()) / trajectory.steps();
    const Quantity quantity = instant_quantity(response);
    for (auto [one, size] :
         {std::pair(quantities::length, size_), std::pair(quantities::angle, 1.0)}) {
      if (quantity == one) return tiny_length * size;
      double way = tiny_way * size;
      for (int i = 0; i < most_rates; ++i) {
        one = per_time(one);
        way /= step;
        if (quantity == one) return way;
      }
    }
    return 0.0;
  }

  /// What a strain of round-off makes of a response of beams: positions of the size of the mechanism
  /// carry it.
  double strain_scale(const ResponseSettings& response) const {
    double scale = 0.0;
    for (const std::string& name : bodies_of(response)) {
      for (const BodyModel* body : model_.parts(name)) {
        if (!body->is_beam() || !body->is_elastic) continue;
        for (const BeamElement<double>& element : body->beam.elements) {
          scale = std::max(scale, tiny_strain * of_unit_strain(response, element));
        }
      }
    }
    return scale;
  }

  double of_unit_strain(const ResponseSettings& response,
                        const BeamElement<double>& element) const {
    const double force = element.young * element.section.area;
    if (response.is<BucklingResponse, LateralBucklingResponse>()) return tiny_share / tiny_strain;
    if (const auto* section = response.as<SectionForceResponse>()) {
      return is_force(section->part) ? force : force * size_;
    }
    const auto* stress = response.as<StressResponse>();
    const bool is_share = stress != nullptr && stress->part == StressPart::utilization;
    const bool is_stress = response.is<StressResponse, ShearStressResponse>();
    return is_stress && !is_share ? element.young : 0.0;
  }

  template <class Other>
  std::vector<Measure> measures_of(const Other&) const {
    return {};
  }

  std::vector<Measure> measures_of(const StressResponse& stress) const {
    StressResponse whole{anywhere_in(stress.where)};
    if (stress.part == StressPart::utilization) whole.part = stress.part;
    return {{whole, stress.where.station ? vanishing : tiny_force}};
  }

  std::vector<Measure> measures_of(const ShearStressResponse& stress) const {
    return {{StressResponse{anywhere_in(stress.where)}}};
  }

  static StressPlaces anywhere_in(StressPlaces places) {
    places.segment.reset();
    places.station.reset();
    return places;
  }

  /// Of a rate of a vector.
  template <class OfVector>
  requires requires(OfVector motion) { motion.component; }
  std::vector<Measure> measures_of(const OfVector& motion) const {
    if (motion.derivative == TimeDerivative::none) return {};
    OfVector whole = motion;
    whole.component = {magnitude_direction};
    return {{whole}};
  }

  std::vector<Measure> measures_of(const ReactionResponse& reaction) const {
    return reactions(reaction.joint, reaction.kind == ReactionKind::moment);
  }

  std::vector<Measure> measures_of(const DriveResponse& drive) const {
    if (drive.kind == DriveNumber::power) return power();
    return reactions(drive.joint, drive.kind == DriveNumber::torque);
  }

  std::vector<Measure> measures_of(const LoadResponse& load) const {
    const bool is_power =
        load.kind == LoadNumber::motor_power || load.kind == LoadNumber::damper_power;
    return is_power ? power() : std::vector<Measure>();
  }

  std::vector<Measure> power() const {
    const Eigen::VectorXd& time = run_.analysis.trajectory.time;
    return {{EnergyResponse(), tiny_energy() / time(time.size() - 1)}};
  }

  /// Of the energy in the motion: what holds it.
  double tiny_energy() const {
    const double steps = run_.analysis.trajectory.steps();
    return std::clamp(tiny_inertia * steps * steps, tiny_force, most_inertia);
  }

  /// Bending moments and axial force anywhere in the body: at a pin or a free end that of the section
  /// itself is nothing but round-off. A force is a moment by the size of the mechanism.
  std::vector<Measure> measures_of(const SectionForceResponse& force) const {
    SectionForceResponse whole = force;
    const bool is_force = pleuel::is_force(whole.part);
    whole.station.reset();
    whole.side.reset();
    std::vector<Measure> measures = {{whole, vanishing}};
    for (const SectionForcePart part : {SectionForcePart::moment_y, SectionForcePart::moment_z}) {
      whole.part = part;
      measures.push_back({whole, tiny_force / (is_force ? size_ : 1.0)});
    }
    if (has_stretch(whole.body)) {
      whole.part = SectionForcePart::axial;
      measures.push_back({whole, tiny_force * (is_force ? 1.0 : size_)});
    }
    return measures;
  }

  /// Whether the beam has axial displacements, from which an axial force is recovered.
  bool has_stretch(const std::string& name) const {
    const ElasticCoordinates& coordinates = model_.parts(name).front()->coordinates;
    for (int node = 0; node < coordinates.node_count(); ++node) {
      if (coordinates.index(node, 0) >= 0) return true;
    }
    return false;
  }

  /// Force and moment in the joint, and the energy of motion; a moment as a force at the size of
  /// the mechanism, or as an energy by one radian.
  std::vector<Measure> reactions(const std::string& joint, bool is_moment) const {
    const double arm = is_moment ? 1.0 : size_;
    return {{ReactionResponse{joint, ReactionKind::force, magnitude_direction},
             tiny_force * (is_moment ? size_ : 1.0)},
            {ReactionResponse{joint, ReactionKind::moment, magnitude_direction}, tiny_force / arm},
            {EnergyResponse(), tiny_energy() / arm}};
  }

  /// The largest magnitudes over the simulation, in order.
  std::vector<double> measure(const std::vector<std::vector<Measure>>& measures) const {
    std::vector<ResponseSettings> settings;
    for (std::size_t i = 0; i < measures.size(); ++i) {
      const std::string& name = run_.problem.responses[i].name;
      for (const Measure& one : measures[i]) {
        settings.push_back({name, one.what, OverTime::max_abs});
      }
    }
    if (settings.empty()) return {};
    const std::vector<Response> responses = make_responses(settings, model_);
    const Trajectory& trajectory = run_.analysis.trajectory;
    const bool has_map = std::ranges::any_of(
        responses, [](const Response& response) { return response.history()->map != nullptr; });
    const int stride = has_map ? 1 : std::max(1, trajectory.steps() / enough_instants);
    const int instants = trajectory.steps() / stride + 1;
    Recorder recorder(responses, instants);
    for (int i = 0; i < instants; ++i) {
      const State state = trajectory.state_at(i * stride);
      recorder.see(i, state);
    }
    const Histories observed = recorder.take(instants);
    std::vector<double> all;
    for (std::size_t i = 0; i < responses.size(); ++i) {
      if (responses[i].history()->map) {
        all.push_back(largest(mapped_history(responses[i], trajectory.time, observed[i])));
      } else {
        all.push_back(largest(observed[i]));
      }
    }
    return all;
  }

  const TrustedRun& run_;
  const Model& model_;
  double size_ = 1.0;  ///< of the mechanism [m]
};

}  // namespace

std::vector<bool> find_round_off(const TrustedRun& run) {
  std::optional<std::vector<bool>>& found = run.shared->is_round_off;
  if (!found) found = RoundOff(run).find();
  return *found;
}

}  // namespace pleuel
