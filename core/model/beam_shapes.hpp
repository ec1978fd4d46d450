#pragma once

#include <memory>
#include <vector>

#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Sets what the elements of a beam say of it beside the invariants: its places, which are the
/// nodes, and the members of geometric stiffening, if it has that; with their derivatives.
/// @param basis    Z of d = Z q_f, with d the nodal displacements
/// @param basis_x  its derivatives, in the order of BodyModel::beam_x
void set_shapes(const SparseMatrix& basis, const std::vector<SparseMatrix>& basis_x,
                BodyModel& model);

/// Geometric stiffening of a body that has it.
std::unique_ptr<Term> make_stiffening(const BodyModel& body);

}  // namespace pleuel
