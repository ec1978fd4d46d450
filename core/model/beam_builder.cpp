#include <algorithm>
#include <array>
#include <set>

#include "core/base/eager_matrices.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/model/elastic_builders.hpp"
#include "core/model/invariant_derivatives.hpp"
#include "core/model/resolve_beam.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

namespace {

/// In a plane: displacements along local axes in the plane, rotations about the one normal to it.
NodalFlags active_displacements(const BodyFrame& frame) {
  if (frame.rotation == RotationCoordinates::rotation_vector) {
    return {true, true, true, true, true, true};
  }
  NodalFlags active{};
  const Eigen::Vector3d normal = frame.reference.transpose() * frame.axis;
  for (int i = 0; i < 3; ++i) {
    const bool is_normal = std::abs(normal(i)) > 0.5;
    active[i] = !is_normal;
    active[static_cast<std::size_t>(i) + 3] = is_normal;
  }
  return active;
}

ElasticCoordinates clamped_coordinates(ReferenceCondition condition, int nodes,
                                       const NodalFlags& active) {
  switch (condition) {
    case ReferenceCondition::tangent:
      return tangent_coordinates(nodes, active);
    case ReferenceCondition::tangent_end:
      return tangent_end_coordinates(nodes, active);
    default:
      return chord_coordinates(nodes, active);
  }
}

/// Nodes of a beam that joints and loads act on, or next to which they do.
std::vector<int> held_nodes(const BeamBody& beam, const Body& body, const BuildContext& context,
                            const BeamMesh& mesh) {
  std::vector<int> nodes;
  for (const AttachedPoint& point : attached_points(context.scene, body.name)) {
    const ElementPlace place = find_place(mesh, share_along(beam, point.at, context.start));
    if (place.is_node()) {
      nodes.push_back(place.node());
    } else {
      nodes.insert(nodes.end(), {place.element, place.element + 1});
    }
  }
  return nodes;
}

class BasisBuilder {
 public:
  BasisBuilder(const BeamBody& beam, const Body& body, const BuildContext& context,
               const NodalFlags& active, BodyModel& model)
      : beam_(beam),
        body_(body),
        context_(context),
        model_(model),
        clamped_(clamped_coordinates(beam.frame, model.beam.node_count(), active)) {
    for (int i = 0; i < 6; ++i) {
      if (active[i]) motions_.push_back(i);
    }
  }

  /// Sets the invariants in the coordinates of the basis.
  /// @param nodal  those in the nodal coordinates of the model, with derivatives
  BasisWithDerivatives build(const Invariants<double>& nodal,
                             const std::vector<DesignDerivative<Invariants<double>>>& nodal_x) {
    const NodalMatrices matrices = matrices_of(nodal, positions(), 1.0);
    std::vector<NodalMatrices> changes;
    for (std::size_t k = 0; k < nodal_x.size(); ++k) {
      changes.push_back(matrices_of(nodal_x[k].data, position_changes(k), 0.0));
    }
    BasisWithDerivatives deformations = deformations_of(matrices, changes);
    BasisWithDerivatives basis =
        is_mean_axis() ? mean_axis_basis(matrices, changes, deformations, motions_) : deformations;
    model_.invariants = project_invariants(nodal, basis.basis);
    for (std::size_t k = 0; k < nodal_x.size(); ++k) {
      model_.invariants_x.push_back(
          {nodal_x[k].variable,
           project_derivative(nodal, nodal_x[k].data, basis.basis, basis.derivatives[k])});
    }
    damp_modes();
    return basis;
  }

 private:
  bool is_mean_axis() const { return beam_.frame == ReferenceCondition::mean_axis; }

  std::vector<double> positions() const {
    std::vector<double> x;
    for (int i = 0; i < model_.beam.node_count(); ++i) x.push_back(model_.beam.node_position(i));
    return x;
  }
  std::vector<double> position_changes(std::size_t k) const {
    std::vector<double> x;
    const Beam<Dual>& beam = model_.beam_x[k].second;
    for (int i = 0; i < beam.node_count(); ++i) x.push_back(derivative_of(beam.node_position(i)));
    return x;
  }

  NodalMatrices matrices_of(const Invariants<double>& nodal, const std::vector<double>& x,
                            double translation) const {
    NodalMatrices matrices;
    matrices.mass = dense_matrix(nodal.pattern, nodal.mass_matrix);
    matrices.stiffness = dense_matrix(nodal.pattern, nodal.stiffness);
    matrices.momentum.resize(6, nodal.size());
    matrices.momentum.topRows(3) = nodal.shape;
    for (int i = 0; i < 3; ++i) {  // (p₀ × S)ᵢ = p₀ⱼ S_k − p₀ₖ Sⱼ
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      matrices.momentum.row(3 + i) = nodal.mixed.row(3 * j + k) - nodal.mixed.row(3 * k + j);
    }
    matrices.rigid = rigid_displacements(model_.coordinates, x, translation);
    return matrices;
  }

  /// Restricts to the coordinates that a clamped frame leaves free.
  NodalMatrices clamp(const NodalMatrices& matrices) const {
    const std::vector<int> free = free_coordinates();
    NodalMatrices clamped;
    clamped.mass = matrices.mass(free, free);
    clamped.stiffness = matrices.stiffness(free, free);
    return clamped;
  }

  /// Indices in the nodal coordinates of the model of those that are not clamped.
  std::vector<int> free_coordinates() const {
    std::vector<int> free;
    for (int node = 0; node < clamped_.node_count(); ++node) {
      for (int i = 0; i < 6; ++i) {
        if (clamped_.index(node, i) >= 0) free.push_back(model_.coordinates.index(node, i));
      }
    }
    return free;
  }

  /// Columns: deformations against the clamped frame.
  BasisWithDerivatives deformations_of(const NodalMatrices& matrices,
                                       const std::vector<NodalMatrices>& changes) const {
    const std::vector<int> free = free_coordinates();
    const Eigen::Index size = free.size();
    BasisWithDerivatives reduced;
    if (beam_.reduction) {
      std::vector<NodalMatrices> clamped_changes;
      for (const NodalMatrices& change : changes) clamped_changes.push_back(clamp(change));
      reduced = craig_bampton_basis(clamp(matrices), clamped_changes, kept_coordinates());
    } else {
      reduced.basis = Eigen::MatrixXd::Identity(size, size);
      reduced.derivatives.assign(changes.size(), Eigen::MatrixXd::Zero(size, size));
    }
    const auto expand = [&](const Eigen::MatrixXd& part) {
      Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(model_.coordinates.size(), part.cols());
      whole(free, Eigen::all) = part;
      return whole;
    };
    BasisWithDerivatives result{expand(reduced.basis), {}};
    for (const auto& change : reduced.derivatives) result.derivatives.push_back(expand(change));
    return result;
  }

  /// Nodes of joints and loads; with stiffening all axial displacements, too: bending shortens a
  /// member everywhere, and few axial modes would lock it. The numbers of modes are decided at the
  /// start design.
  KeptCoordinates kept_coordinates() const {
    KeptCoordinates kept = boundary_and_families();
    const Beam<double> at_start = resolve_beam(beam_, model_.mesh, context_.scene, context_.start);
    const Invariants<double> start = beam_invariants(at_start, clamped_);
    NodalMatrices matrices;
    matrices.mass = dense_matrix(start.pattern, start.mass_matrix);
    matrices.stiffness = dense_matrix(start.pattern, start.stiffness);
    for (ModeFamily& family : kept.families) {
      const CraigBampton& asked = *beam_.reduction;
      const int modes =
          asked.modes ? *asked.modes
                      : count_fixed_interface_modes(matrices, family.coordinates, *asked.frequency);
      family.modes = complete_modes(matrices, family.coordinates, modes + asked.more_modes);
    }
    return kept;
  }

  /// The families are axial vibration, torsion, and bending in each plane of symmetry.
  KeptCoordinates boundary_and_families() const {
    constexpr std::array<std::size_t, 6> family_of = {0, 1, 2, 3, 2, 1};  // u v w θx θy θz
    const std::vector<int> attached = held_nodes(beam_, body_, context_, model_.mesh);
    KeptCoordinates kept;
    kept.families.resize(4);
    for (int node = 0; node < clamped_.node_count(); ++node) {
      const bool is_attached = std::ranges::find(attached, node) != attached.end();
      for (int i = 0; i < 6; ++i) {
        const int index = clamped_.index(node, i);
        const bool is_kept = is_attached || (i == 0 && model_.has_stiffening);
        if (index < 0) continue;
        ModeFamily& family = kept.families[family_of[i]];
        (is_kept ? kept.boundary : family.coordinates).push_back(index);
      }
    }
    return kept;
  }

  void damp_modes() {
    if (!beam_.damping.modal.is_bound() && beam_.damping.modal.constant == 0.0) return;
    const auto dense = [&](const Invariants<double>& i, double ratio) {
      return DampedMatrices{dense_matrix(i.pattern, i.mass_matrix),
                            dense_matrix(i.pattern, i.stiffness), ratio};
    };
    std::vector<DampedMatrices> changes;
    for (const auto& [variable, change] : model_.invariants_x) {
      changes.push_back(
          dense(change, derivative_by(variable, beam_.damping.modal, context_.design)));
    }
    const ModalDamping damping = modal_damping(
        dense(model_.invariants, resolve(beam_.damping.modal, context_.design)), changes);
    set_damping(damping.damping, model_.invariants);
    for (std::size_t k = 0; k < changes.size(); ++k) {
      set_damping(damping.derivatives[k], model_.invariants_x[k].data);
    }
  }

  static void set_damping(const Eigen::MatrixXd& matrix, Invariants<double>& invariants) {
    // The pattern is full, by rows; the matrix is symmetric.
    invariants.damping = Eigen::Map<const Eigen::VectorXd>(matrix.data(), matrix.size());
  }

  const BeamBody& beam_;
  const Body& body_;
  const BuildContext& context_;
  BodyModel& model_;
  ElasticCoordinates clamped_;
  std::vector<int> motions_;
};

SparseMatrix identity(int size) {
  SparseMatrix matrix(size, size);
  matrix.setIdentity();
  return matrix;
}

/// With those of the places that its mesh follows.
std::set<int> beam_variables(const Body& body, const BeamMesh& mesh, const Scene& scene) {
  std::set<int> variables = variables_of(body, scene);
  for (const MeshKnot& knot : mesh.knots) {
    if (knot.at) add_variables_of(*knot.at, variables);
  }
  return variables;
}

}  // namespace

void set_beam(const BeamBody& beam, const Body& body, const BuildContext& context,
              BodyModel& model) {
  const BodyEffects& effects = context.effects_of(model.name);
  model.kind = BodyKind::beam;
  model.condition = beam.frame;
  if (beam.part) {
    model.stretch = {beam.part->begin, beam.part->end, beam.part->first_element};
  }
  model.mesh = make_mesh(body, context.scene, context.start, effects.elasticity);
  model.beam = resolve_beam(beam, model.mesh, context.scene, context.design);
  model.bends_alike = std::ranges::all_of(beam.segments, [](const Segment& segment) {
    return std::holds_alternative<CircleSection>(segment.section) ||
           std::holds_alternative<TubeSection>(segment.section);
  });
  const std::set<int> variables =
      context.differentiated(beam_variables(body, model.mesh, context.scene));
  for (const int variable : variables) {
    model.beam_x.emplace_back(
        variable, resolve_beam(beam, model.mesh, context.scene, context.seeded(variable)));
  }
  model.is_elastic = effects.elasticity;
  model.has_stiffening = effects.elasticity && effects.geometric_stiffening;
  NodalFlags active{};
  if (effects.elasticity) active = active_displacements(model.frame);
  if (!effects.axial_elasticity) active[0] = false;
  if (!effects.torsional_elasticity) active[3] = false;
  const bool is_mean_axis = beam.frame == ReferenceCondition::mean_axis;
  const int nodes = model.beam.node_count();
  model.coordinates = is_mean_axis ? ElasticCoordinates(nodes, active)
                                   : clamped_coordinates(beam.frame, nodes, active);

  const RotaryInertia rotary =
      effects.rotary_inertia ? RotaryInertia::included : RotaryInertia::neglected;
  const Invariants<double> nodal = beam_invariants(model.beam, model.coordinates, rotary);
  std::vector<DesignDerivative<Invariants<double>>> nodal_x;
  for (const int variable : variables) {
    nodal_x.push_back(
        {variable, differentiate_invariants(context, variable, [&](const auto& design) {
           return varied_invariants(resolve_beam(beam, model.mesh, context.scene, design),
                                    model.coordinates, rotary);
         })});
  }
  model.has_basis = effects.elasticity && (is_mean_axis || beam.reduction);
  SparseMatrix basis = identity(nodal.size());
  std::vector<SparseMatrix> basis_x(nodal_x.size(), SparseMatrix(nodal.size(), nodal.size()));
  if (model.has_basis) {
    const BasisWithDerivatives modes =
        BasisBuilder(beam, body, context, active, model).build(nodal, nodal_x);
    basis = modes.basis.sparseView();
    for (std::size_t k = 0; k < basis_x.size(); ++k) basis_x[k] = modes.derivatives[k].sparseView();
  } else {
    model.invariants = nodal;
    model.invariants_x = std::move(nodal_x);
  }
  set_shapes(basis, basis_x, model);
}

}  // namespace pleuel
