#include "core/model/body_builder.hpp"

#include "core/effects/floating_frame_body.hpp"
#include "core/effects/geometric_stiffening.hpp"

namespace pleuel {

Design<Dual> BuildContext::seeded(int variable) const {
  Design<Dual> dual;
  for (double value : design) dual.emplace_back(value);
  dual[static_cast<std::size_t>(variable)].derivatives()[0] = 1.0;
  return dual;
}

namespace {

BodyFrame make_frame(const Body& body, const BuildContext& context, int offset) {
  BodyFrame frame;
  frame.offset = offset;
  const bool is_point = std::holds_alternative<PointMass>(body.shape);
  if (!context.plane) {
    if (!is_point) frame.rotation = RotationCoordinates::rotation_vector;
    return frame;
  }
  const MotionPlane& plane = *context.plane;
  frame.basis = plane.basis;
  frame.origin = plane.point.dot(plane.normal) * plane.normal;
  if (is_point) return frame;
  frame.rotation = RotationCoordinates::angle;
  frame.axis = plane.normal;
  // φ = 0 where local x is the first direction of the plane.
  const Matrix3<double> start = body_pose(body, context.start).rotation;
  const Eigen::Vector3d x = start.col(0);
  const double angle = std::atan2(x.dot(plane.basis.col(1)), x.dot(plane.basis.col(0)));
  frame.reference = Eigen::AngleAxisd(-angle, plane.normal) * start;
  return frame;
}

/// In a plane: displacements along local axes in the plane, rotations about the one normal to it.
NodalFlags active_displacements(const BodyFrame& frame) {
  if (frame.rotation == RotationCoordinates::rotation_vector) {
    return {true, true, true, true, true, true};
  }
  NodalFlags active{};
  const Eigen::Vector3d normal = frame.reference.transpose() * frame.axis;
  for (int i = 0; i < 3; ++i) {
    const bool is_normal = std::abs(normal(i)) > 0.5;
    active[static_cast<std::size_t>(i)] = !is_normal;
    active[static_cast<std::size_t>(i) + 3] = is_normal;
  }
  return active;
}

bool wants_stiffening(const BuildContext& context) {
  return context.effects.geometric_stiffening != EffectChoice::off;
}

void set_beam(const BeamBody& beam, const Body& body, const BuildContext& context,
              BodyModel& model) {
  model.beam = resolve_beam(beam, context.scene, context.design);
  for (int variable : variables_of(body, context.scene)) {
    model.beam_x.emplace_back(variable,
                              resolve_beam(beam, context.scene, context.seeded(variable)));
  }
  const NodalFlags active = active_displacements(model.frame);
  const int nodes = model.beam.node_count();
  model.coordinates = beam.frame == ReferenceCondition::tangent ? tangent_coordinates(nodes, active)
                                                                : chord_coordinates(nodes, active);
  for (std::size_t s = 0; s < beam.segments.size(); ++s) {
    model.segment_of_element.insert(model.segment_of_element.end(),
                                    static_cast<std::size_t>(beam.segments[s].elements),
                                    static_cast<int>(s));
  }
  model.has_stiffening = wants_stiffening(context);
}

template <class Scalar>
Invariants<Scalar> make_invariants(const Body& body, const BodyModel& model,
                                   const Beam<Scalar>& beam, const Design<Scalar>& design) {
  if (model.is_beam()) return beam_invariants(beam, *model.coordinates);
  const Vector3<Scalar> zero = Vector3<Scalar>::Constant(Scalar(0));
  Matrix3<Scalar> second = Matrix3<Scalar>::Constant(Scalar(0));
  if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
    std::array<Scalar, 6> i;
    for (std::size_t k = 0; k < 6; ++k) i[k] = resolve(rigid->inertia[k], design);
    // ∫ρ p pᵀ = ½ tr(I) 1 − I
    second << -i[0], -i[3], -i[4], -i[3], -i[1], -i[5], -i[4], -i[5], -i[2];
    const Scalar half_trace = (i[0] + i[1] + i[2]) / 2.0;
    for (int k = 0; k < 3; ++k) second(k, k) += half_trace;
    return rigid_invariants<Scalar>(resolve(rigid->mass, design), zero, second);
  }
  return rigid_invariants<Scalar>(resolve(std::get<PointMass>(body.shape).mass, design), zero,
                                  second);
}

/// The beam of a seeded design, which the body model keeps already; empty for other bodies.
Beam<Dual> seeded_beam(const BodyModel& model, int variable) {
  for (const auto& [index, beam] : model.beam_x) {
    if (index == variable) return beam;
  }
  return {};
}

struct LocalElement {
  std::vector<int> local;  ///< active element coordinates, 0 … 11
  StiffeningElement element;
};

LocalElement make_stiffening_element(const BodyModel& model, int e) {
  LocalElement result;
  const BeamElement<double>& source = model.beam.elements[static_cast<std::size_t>(e)];
  const Eigen::Matrix<double, 12, 12> slopes = slope_matrix(source.length);
  for (int i = 0; i < 12; ++i) {
    const int index = model.coordinate(e + i / 6, i % 6);
    if (index < 0) continue;
    result.local.push_back(i);
    result.element.coordinates.push_back(index);
  }
  const auto size = static_cast<Eigen::Index>(result.local.size());
  result.element.elongation.setZero(size);
  result.element.slopes.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int local = result.local[static_cast<std::size_t>(i)];
    if (local % 6 == 0) result.element.elongation(i) = local == 0 ? -1.0 : 1.0;
    for (Eigen::Index j = 0; j < size; ++j) {
      result.element.slopes(i, j) = slopes(local, result.local[static_cast<std::size_t>(j)]);
    }
  }
  result.element.axial_stiffness = source.young * source.section.area / source.length;
  return result;
}

StiffeningDerivative differentiate_stiffening(const LocalElement& local, int e,
                                              const Beam<Dual>& beam) {
  const BeamElement<Dual>& element = beam.elements[static_cast<std::size_t>(e)];
  StiffeningDerivative derivative;
  derivative.element = e;
  const Dual stiffness = element.young * element.section.area / element.length;
  derivative.axial_stiffness = derivative_of(stiffness);
  derivative.damping = derivative_of(beam.stiffness_damping);
  const Eigen::MatrixXd slopes = derivative_matrix(slope_matrix(element.length));
  const auto size = static_cast<Eigen::Index>(local.local.size());
  derivative.slopes.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      derivative.slopes(i, j) = slopes(local.local[static_cast<std::size_t>(i)],
                                       local.local[static_cast<std::size_t>(j)]);
    }
  }
  return derivative;
}

std::unique_ptr<Term> make_stiffening(const BodyModel& model) {
  std::vector<LocalElement> locals;
  std::vector<StiffeningElement> elements;
  for (int e = 0; e < static_cast<int>(model.beam.elements.size()); ++e) {
    locals.push_back(make_stiffening_element(model, e));
    elements.push_back(locals.back().element);
  }
  std::vector<DesignDerivative<std::vector<StiffeningDerivative>>> derivatives;
  for (const auto& [variable, beam] : model.beam_x) {
    std::vector<StiffeningDerivative> changes;
    for (std::size_t e = 0; e < locals.size(); ++e) {
      StiffeningDerivative change = differentiate_stiffening(locals[e], static_cast<int>(e), beam);
      const bool is_zero =
          change.axial_stiffness == 0.0 && change.damping == 0.0 && change.slopes.isZero(0.0);
      if (!is_zero) changes.push_back(std::move(change));
    }
    if (!changes.empty()) derivatives.push_back({variable, std::move(changes)});
  }
  return std::make_unique<GeometricStiffening>(
      model.name, std::move(elements), model.beam.stiffness_damping, std::move(derivatives));
}

}  // namespace

BodyModel make_body_model(const Body& body, const BuildContext& context, int offset) {
  BodyModel model;
  model.name = body.name;
  model.frame = make_frame(body, context, offset);
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    set_beam(*beam, body, context, model);
  }
  model.mass = make_invariants(body, model, model.beam, context.design).mass;
  model.mass_x = Eigen::VectorXd::Zero(context.variables());
  return model;
}

std::vector<std::unique_ptr<Term>> make_body_terms(const Body& body, BodyModel& model,
                                                   const BuildContext& context) {
  std::vector<DesignDerivative<Invariants<double>>> derivatives;
  for (int variable : variables_of(body, context.scene)) {
    const Invariants<Dual> seeded =
        make_invariants(body, model, seeded_beam(model, variable), context.seeded(variable));
    model.mass_x(variable) = derivative_of(seeded.mass);
    derivatives.push_back({variable, transform_invariants<double>(seeded, [](const Dual& number) {
                             return derivative_of(number);
                           })});
  }
  std::vector<std::unique_ptr<Term>> terms;
  terms.push_back(std::make_unique<FloatingFrameBody>(
      body.name, model.frame, make_invariants(body, model, model.beam, context.design),
      std::move(derivatives), context.gravity));
  if (model.has_stiffening) terms.push_back(make_stiffening(model));
  return terms;
}

}  // namespace pleuel
