#include "core/trust/round_off.hpp"

#include <algorithm>
#include <complex>
#include <optional>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/make_responses.hpp"
#include "core/response/recorder.hpp"
#include "core/scene/response_kind.hpp"
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
  ResponseSettings settings;
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
    for (const ResponseSettings& response : responses) measures.push_back(measures_of(response));
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
      if (responses[i].type == ResponseType::expression) is_round_off[i] = are_all(is_round_off, i);
    }
    return is_round_off;
  }

 private:
  /// Of a damped mode: whether its number is next to nothing beside its eigenvalue.
  bool is_tiny_rate(std::size_t response) const {
    if (!run_.analysis.responses[response].mode()->choice.counts_damping()) return false;
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
    ResponseSettings instant = response;
    instant.over_time = OverTime::final;
    const Quantity quantity = quantity_of(instant);
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
    for (const std::string& name : response.bodies) {
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
    switch (observed_type(response.type)) {
      case ResponseType::buckling:
      case ResponseType::lateral_buckling:
        return tiny_share / tiny_strain;
      case ResponseType::section_force:
        return is_force(response.section_part) ? force : force * size_;
      case ResponseType::shear_stress:
        return element.young;
      case ResponseType::stress:
        return response.part == StressPart::utilization ? 0.0 : element.young;
      default:
        return 0.0;
    }
  }

  std::vector<Measure> measures_of(const ResponseSettings& response) const {
    ResponseSettings whole = response;
    whole.over_time = OverTime::max_abs;
    whole.from = whole.to = std::nullopt;
    switch (observed_type(response.type)) {
      case ResponseType::stress:
        whole.segment = std::nullopt;
        whole.station = std::nullopt;
        if (response.part != StressPart::utilization) whole.part = StressPart::von_mises;
        return {{whole, response.station ? vanishing : tiny_force}};
      case ResponseType::shear_stress:
        whole.type = ResponseType::stress;
        whole.segment = std::nullopt;
        whole.station = std::nullopt;
        whole.part = StressPart::von_mises;
        return {{whole}};
      case ResponseType::section_force:
        return section_forces(whole);
      case ResponseType::velocity:
      case ResponseType::acceleration:
      case ResponseType::angular_velocity:
      case ResponseType::angular_acceleration:
        whole.direction = magnitude_direction;
        whole.along = std::nullopt;
        return {{whole}};
      case ResponseType::reaction_force:
      case ResponseType::reaction_moment:
      case ResponseType::drive_torque:
      case ResponseType::drive_force:
        return reactions(whole, response.type);
      case ResponseType::drive_power:
      case ResponseType::motor_power:
      case ResponseType::damper_power: {
        whole.type = ResponseType::kinetic_energy;
        const Eigen::VectorXd& time = run_.analysis.trajectory.time;
        return {{whole, tiny_energy() / time(time.size() - 1)}};
      }
      default:
        return {};
    }
  }

  /// Of the energy in the motion: what holds it.
  double tiny_energy() const {
    const double steps = run_.analysis.trajectory.steps();
    return std::clamp(tiny_inertia * steps * steps, tiny_force, most_inertia);
  }

  /// Bending moments and axial force anywhere in the body: at a pin or a free end that of the section
  /// itself is nothing but round-off. A force is a moment by the size of the mechanism.
  std::vector<Measure> section_forces(ResponseSettings whole) const {
    const bool is_force = pleuel::is_force(whole.section_part);
    whole.station = std::nullopt;
    whole.side = std::nullopt;
    std::vector<Measure> measures = {{whole, vanishing}};
    for (const SectionForcePart part : {SectionForcePart::moment_y, SectionForcePart::moment_z}) {
      whole.section_part = part;
      measures.push_back({whole, tiny_force / (is_force ? size_ : 1.0)});
    }
    if (has_stretch(whole.bodies.front())) {
      whole.section_part = SectionForcePart::axial;
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
  std::vector<Measure> reactions(ResponseSettings whole, ResponseType type) const {
    const bool is_moment =
        type == ResponseType::reaction_moment || type == ResponseType::drive_torque;
    whole.direction = magnitude_direction;
    whole.type = ResponseType::reaction_force;
    const Measure force{whole, tiny_force * (is_moment ? size_ : 1.0)};
    whole.type = ResponseType::reaction_moment;
    const Measure moment{whole, tiny_force / (is_moment ? 1.0 : size_)};
    whole.type = ResponseType::kinetic_energy;
    return {force, moment, {whole, tiny_energy() / (is_moment ? 1.0 : size_)}};
  }

  /// The largest magnitudes over the simulation, in order.
  std::vector<double> measure(const std::vector<std::vector<Measure>>& measures) const {
    std::vector<ResponseSettings> settings;
    for (const auto& of_one : measures) {
      for (const Measure& one : of_one) settings.push_back(one.settings);
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
