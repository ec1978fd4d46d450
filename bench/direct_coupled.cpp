#include "bench/direct_coupled.hpp"

#include <utility>

#include "core/beam/beam_invariants.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/effects/general_body_equations.hpp"
#include "core/model/body_builder.hpp"
#include "core/model/invariant_derivatives.hpp"

namespace pleuel::bench {

namespace {

/// A term of another system.
class BorrowedTerm : public Term {
 public:
  explicit BorrowedTerm(Term& term) : term_(term) {}
  std::string name() const override { return term_.name(); }
  void declare_entries(EntryList& entries) const override { term_.declare_entries(entries); }
  void add_residual(const State& state, ConstraintLevel level, Eigen::VectorXd& out) override {
    term_.add_residual(state, level, out);
  }
  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override {
    term_.linearize(state, weights, level, residual, entries);
  }
  void add_design_derivative(const State& state, ConstraintLevel level,
                             Eigen::MatrixXd& columns) override {
    term_.add_design_derivative(state, level, columns);
  }
  int parameter_adjoint_count() const override { return term_.parameter_adjoint_count(); }
  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums) override {
    term_.add_parameter_adjoints(state, level, mu, sums);
  }
  void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const override {
    term_.add_design_gradients(sums, gradients);
  }

 private:
  Term& term_;
};

/// The term of a beam, with derivatives from its elements.
class CoupledBody final : public BorrowedTerm {
 public:
  CoupledBody(FloatingFrameBody& body, const BodyModel& model, const Eigen::Vector3d& gravity)
      : BorrowedTerm(body), body_(body), model_(model), gravity_(gravity) {}

  void add_design_derivative(const State& state, ConstraintLevel,
                             Eigen::MatrixXd& columns) override {
    const BodyFrame& frame = body_.frame();
    const int size = frame.size() + model_.elastic_size(), first = frame.offset;
    set_body_motion(frame, gravity_, state.q.segment(first, size), state.v.segment(first, size),
                    state.a.segment(first, size), motion_);
    for (const auto& [variable, seeded] : model_.beam_x) {
      const Invariants<double> change = derivative_of(beam_invariants(seeded, model_.coordinates));
      evaluate_body(change, motion_, products_);
      auto column = columns.col(variable);
      add_body_forces(change, frame, motion_, products_, first, column);
    }
  }

 private:
  FloatingFrameBody& body_;
  const BodyModel& model_;
  Eigen::Vector3d gravity_;
  BodyMotion motion_;
  BodyProducts products_;
};

const BodyModel* beam_of(const Model& model, const FloatingFrameBody& term) {
  for (const BodyModel& body : model.bodies) {
    if (body.is_beam() && body.frame.offset == term.frame().offset) return &body;
  }
  return nullptr;
}

std::unique_ptr<System> coupled_system(const Model& model, const System& system) {
  std::vector<std::unique_ptr<Term>> terms;
  for (const auto& term : system.terms()) {
    auto* body = dynamic_cast<FloatingFrameBody*>(term.get());
    const BodyModel* beam = body != nullptr ? beam_of(model, *body) : nullptr;
    if (beam != nullptr) {
      terms.push_back(std::make_unique<CoupledBody>(*body, *beam, model.gravity));
    } else {
      terms.push_back(std::make_unique<BorrowedTerm>(*term));
    }
  }
  auto coupled = std::make_unique<System>(system.coordinates(), system.multipliers(),
                                          system.variables(), std::move(terms));
  coupled->deactivate(system.left_out());
  return coupled;
}

}  // namespace

Eigen::MatrixXd direct_coupled_gradients(Analysis& analysis,
                                         const std::vector<SampledValue>& values) {
  std::unique_ptr<System>& system = analysis.model.mechanism.system;
  std::unique_ptr<System> coupled = coupled_system(analysis.model, *system);
  std::swap(system, coupled);
  Eigen::MatrixXd gradients = sampled_gradients(analysis, values, ExactMethod::direct);
  std::swap(system, coupled);
  return gradients;
}

}  // namespace pleuel::bench
