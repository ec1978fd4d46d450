#include "core/response/energy_signals.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/model/body_energy.hpp"
#include "core/response/term_product.hpp"

namespace pleuel {

namespace {

/// Σ over bodies of a weighted sum of their energies.
class EnergySum {
 public:
  EnergySum(std::vector<const BodyModel*> bodies, const Eigen::Vector3d& gravity,
            const EnergyWeights& weights)
      : bodies_(std::move(bodies)), gravity_(gravity), weights_(weights) {}

  double value(const State& state) const {
    double sum = 0.0;
    for (const BodyModel* body : bodies_) {
      sum += weights_.sum(body_energy(*body, body->invariants, gravity_, state));
    }
    return sum;
  }

  void add_gradient(const State& state, double weight, SignalGradient& gradient) const {
    const EnergyWeights weighted{weight * weights_.kinetic, weight * weights_.elastic,
                                 weight * weights_.weight, weight * weights_.dissipation};
    for (const BodyModel* body : bodies_) {
      add_energy_gradient(*body, gravity_, state, weighted, gradient.q, gradient.v);
      for (const auto& [variable, invariants] : body->invariants_x) {
        gradient.design(variable) += weighted.sum(body_energy(*body, invariants, gravity_, state));
      }
    }
  }

 private:
  std::vector<const BodyModel*> bodies_;
  Eigen::Vector3d gravity_;
  EnergyWeights weights_;
};

/// What geometric stiffening stores of itself: bending that shortens a beam, and stretches it where
/// it cannot. Its force f at rest has a potential, so that
///     V(q) = ∫₀¹ qᵀ f(τ q) dτ,    ∂V/∂q = f
/// f is of second and third degree in q: two Gauss points are exact.
class StretchingEnergy {
 public:
  /// @param terms  of geometric stiffening; must outlive this
  StretchingEnergy(std::vector<Term*> terms, const System& system)
      : terms_(std::move(terms)),
        at_rest_(system.coordinates(), system.multipliers()),
        forces_(system.size()),
        design_(system.size(), system.variables()) {}

  double value(const State& state) {
    if (terms_.empty()) return 0.0;
    double sum = 0.0;
    for (const double share : gauss_shares) {
      sum += 0.5 * state.q.dot(forces(state, share));
    }
    return sum;
  }

  void add_gradient(const State& state, double weight, SignalGradient& gradient) {
    if (terms_.empty()) return;
    gradient.q += weight * forces(state, 1.0);
    design_.setZero();
    for (const double share : gauss_shares) {
      at_rest_.q = share * state.q;
      for (Term* term : terms_) {
        term->add_design_derivative(at_rest_, ConstraintLevel::position, design_);
      }
    }
    gradient.design += 0.5 * weight * design_.topRows(state.q.size()).transpose() * state.q;
  }

 private:
  static constexpr std::array<double, 2> gauss_shares = {0.5 - 0.5 / std::numbers::sqrt3,
                                                         0.5 + 0.5 / std::numbers::sqrt3};

  /// Those at a share of the deformation.
  Eigen::VectorXd forces(const State& state, double share) {
    at_rest_.q = share * state.q;
    forces_.setZero();
    for (Term* term : terms_) term->add_residual(at_rest_, ConstraintLevel::position, forces_);
    return forces_.head(state.q.size());
  }

  std::vector<Term*> terms_;
  State at_rest_;  ///< v = 0
  Eigen::VectorXd forces_;
  Eigen::MatrixXd design_;  ///< scratch
};

std::vector<const BodyModel*> bodies_of(const Model& model, const std::vector<std::string>& names) {
  std::vector<const BodyModel*> bodies;
  for (const std::string& name : names) {
    const std::vector<const BodyModel*> parts = model.parts(name);
    bodies.insert(bodies.end(), parts.begin(), parts.end());
  }
  if (!bodies.empty()) return bodies;
  for (const BodyModel& body : model.bodies) bodies.push_back(&body);
  return bodies;
}

/// The terms of geometric stiffening of some bodies.
std::vector<Term*> stiffening_of(const Model& model, const std::vector<const BodyModel*>& bodies) {
  std::vector<Term*> chosen;
  for (const auto& [body, term] : model.terms.stiffening) {
    if (std::ranges::find(bodies, &model.bodies[body]) == bodies.end()) continue;
    chosen.push_back(term);
  }
  return chosen;
}

class EnergySignal final : public Signal {
 public:
  EnergySignal(const char* name, EnergySum sum, StretchingEnergy stretching)
      : name_(name), sum_(std::move(sum)), stretching_(std::move(stretching)) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return name_; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = sum_.value(state) + stretching_.value(state);
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    sum_.add_gradient(state, weight, gradient);
    stretching_.add_gradient(state, weight, gradient);
  }

 private:
  const char* name_;
  EnergySum sum_;
  StretchingEnergy stretching_;
};

std::vector<Term*> all_besides_bodies(const Model& model) {
  TermsBesidesBodies besides = terms_besides_bodies(model);
  std::vector<Term*> all = std::move(besides.stiffening);
  all.insert(all.end(), besides.acting.begin(), besides.acting.end());
  return all;
}

/// Power = −vᵀ R − dissipation.
class EnergyAndPowerSignal final : public Signal {
 public:
  explicit EnergyAndPowerSignal(const Model& model)
      : energy_(bodies_of(model, {}), model.gravity, {.kinetic = 1, .elastic = 1, .weight = 1}),
        dissipation_(bodies_of(model, {}), model.gravity, {.dissipation = 1}),
        others_(all_besides_bodies(model), *model.mechanism.system),
        rows_(Eigen::VectorXd::Zero(model.mechanism.system->size())) {}

  int channels() const override { return 2; }
  std::string describe(int channel) const override { return channel == 0 ? "energy" : "power"; }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = energy_.value(state);
    values(1) = -state.v.dot(forces(state)) - dissipation_.value(state);
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    if (channel == 0) {
      energy_.add_gradient(state, weight, gradient);
      return;
    }
    dissipation_.add_gradient(state, -weight, gradient);
    gradient.v -= weight * forces(state);
    rows_.head(state.v.size()) = -weight * state.v;
    others_.add_gradient(state, ConstraintLevel::position, rows_, gradient);
  }

 private:
  Eigen::VectorXd forces(const State& state) {
    return others_.residual(state, ConstraintLevel::position).head(state.v.size());
  }

  EnergySum energy_, dissipation_;
  TermProduct others_;
  Eigen::VectorXd rows_;
};

}  // namespace

std::unique_ptr<Signal> make_kinetic_energy_signal(const Model& model,
                                                   const std::vector<std::string>& bodies) {
  return std::make_unique<EnergySignal>(
      "kinetic energy", EnergySum(bodies_of(model, bodies), model.gravity, {.kinetic = 1}),
      StretchingEnergy({}, *model.mechanism.system));
}

std::unique_ptr<Signal> make_elastic_energy_signal(const Model& model,
                                                   const std::vector<std::string>& names) {
  const std::vector<const BodyModel*> bodies = bodies_of(model, names);
  return std::make_unique<EnergySignal>(
      "elastic energy", EnergySum(bodies, model.gravity, {.elastic = 1}),
      StretchingEnergy(stiffening_of(model, bodies), *model.mechanism.system));
}

std::unique_ptr<Signal> make_energy_and_power_signal(const Model& model) {
  return std::make_unique<EnergyAndPowerSignal>(model);
}

namespace {

class DriftSignal final : public Signal {
 public:
  DriftSignal(const Model& model, ConstraintLevel level)
      : model_(model),
        level_(level),
        terms_(terms_besides_bodies(model).acting, *model.mechanism.system),
        rows_(Eigen::VectorXd::Zero(model.mechanism.system->size())) {}

  int channels() const override { return model_.mechanism.system->multipliers(); }

  std::string describe(int channel) const override {
    for (const JointModel& joint : model_.joints) {
      const int equation = channel - joint.first_multiplier;
      if (equation < 0 || equation >= joint.equations()) continue;
      return fmt::format("joint {}, equation {}", joint.name, equation + 1);
    }
    return fmt::format("equation {}", channel + 1);
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values = terms_.residual(state, level_).tail(channels());
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const auto row = state.q.size() + channel;
    rows_(row) = weight;
    terms_.add_gradient(state, level_, rows_, gradient);
    rows_(row) = 0.0;
  }

 private:
  const Model& model_;
  ConstraintLevel level_;
  TermProduct terms_;
  Eigen::VectorXd rows_;  ///< zero between calls
};

}  // namespace

std::unique_ptr<Signal> make_drift_signal(const Model& model, DriftLevel level) {
  return std::make_unique<DriftSignal>(
      model, level == DriftLevel::position ? ConstraintLevel::position : ConstraintLevel::velocity);
}

}  // namespace pleuel
