#pragma once

#include <memory>
#include <vector>

#include "core/model/build_context.hpp"
#include "core/model/model.hpp"
#include "core/system/term.hpp"

/// What makes elastic bodies: of beams, and of files of invariants.
namespace pleuel {

// beam_builder.cpp

/// Sets what is particular to a beam: elements, elastic coordinates (nodal, or a basis of modes or
/// of the mean axis), invariants and their derivatives.
void set_beam(const BeamBody& beam, const Body& body, const BuildContext& context,
              BodyModel& model);

// beam_shapes.cpp

/// Sets what the elements of a beam say of it beside the invariants: its places, which are the
/// nodes, and the members of geometric stiffening, if it has that; with their derivatives.
/// @param basis    Z of d = Z q_f, with d the nodal displacements
/// @param basis_x  its derivatives, in the order of BodyModel::beam_x
void set_shapes(const SparseMatrix& basis, const std::vector<SparseMatrix>& basis_x,
                BodyModel& model);

/// Geometric stiffening of a body that has it.
std::unique_ptr<Term> make_stiffening(const BodyModel& body);

// imported_builder.cpp

/// A body that is known by its invariants.
/// @throws InputError where the constants are not those of the design, or an effect is asked for
///         that the file knows nothing of
void set_imported(const ImportedBody& imported, const Body& body, const BuildContext& context,
                  BodyModel& model);

/// Lines of the table of effects for a body that was built.
std::vector<EffectRecord> imported_records(const ImportedBody& imported,
                                           const EffectSettings& settings, const BodyModel& model);

}  // namespace pleuel
