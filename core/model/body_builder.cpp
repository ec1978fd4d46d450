#include "core/model/body_builder.hpp"

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/model/divided_beams.hpp"
#include "core/model/elastic_builders.hpp"
#include "core/model/invariant_derivatives.hpp"
#include "core/scene/body_rules.hpp"

namespace pleuel {

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

/// Invariants of a rigid body or a point mass.
template <class Scalar>
Invariants<Scalar> make_rigid_invariants(const Body& body, const Design<Scalar>& design) {
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

void set_rigid(const Body& body, const BuildContext& context, BodyModel& model) {
  model.invariants = make_rigid_invariants(body, context.design);
  for (int variable : context.differentiated(variables_of(body, context.scene))) {
    model.invariants_x.push_back(
        {variable, differentiate_invariants(context, variable, [&](const auto& design) {
           return make_rigid_invariants(body, design);
         })});
  }
}

}  // namespace

BodyModel make_body_model(const Body& body, const BuildContext& context, int offset) {
  BodyModel model;
  model.name = name_in_scene(body);
  if (const auto broken = find_impossible(body, context.design)) {
    throw SimulationError(fmt::format("the body \"{}\" is impossible: {}", model.name, *broken));
  }
  model.frame = make_frame(body, context, offset);
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    set_beam(*beam, body, context, model);
  } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
    set_imported(*imported, body, context, model);
  } else {
    set_rigid(body, context, model);
  }
  if (!model.stretching.elements.empty()) {
    model.stretched = std::make_shared<const StretchedMembers>(stretched_members(model));
  }
  model.mass = model.invariants.mass;
  model.mass_x = Eigen::VectorXd::Zero(context.variables());
  for (const auto& [variable, change] : model.invariants_x) model.mass_x(variable) += change.mass;
  return model;
}

std::unique_ptr<Term> make_body_term(const BodyModel& model, const BuildContext& context) {
  return std::make_unique<FloatingFrameBody>(model.name, model.frame, model.invariants,
                                             model.invariants_x, context.gravity);
}

}  // namespace pleuel
