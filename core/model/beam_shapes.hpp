#pragma once

#include <vector>

#include "core/model/model.hpp"

namespace pleuel {

/// Sets what the elements of a beam say of it beside the invariants: its places, which are the
/// nodes, and the members of geometric stiffening, if it has that; with their derivatives.
/// @param basis    Z of d = Z q_f, with d the nodal displacements
/// @param basis_x  its derivatives, in the order of BodyModel::beam_x
void set_shapes(const SparseMatrix& basis, const std::vector<SparseMatrix>& basis_x,
                BodyModel& model);

}  // namespace pleuel
