#include "core/model/elastic_body.hpp"

#include <set>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;

/// The rows of the displacements of one member.
class MemberRows {
 public:
  MemberRows(const ElasticBody& body, std::size_t member)
      : body_(body), member_(member), rows_(body.stretching.elements[member].displacements) {
    std::set<int> used;
    note_columns(body.stretching.displacements, used);
    for (const auto& [variable, change] : body.stretching_x) {
      note_columns(change.displacements, used);
    }
    columns_.assign(used.begin(), used.end());
  }

  StretchedElement value() const {
    const StretchedElement& element = body_.stretching.elements[member_];
    const MatrixXd z = dense(body_.stretching.displacements);
    return {columns_, z.transpose() * element.elongation, element.axial_stiffness,
            z.transpose() * element.slopes * z};
  }

  /// By the product rule.
  StretchedElement derivative(const Stretching& change) const {
    const StretchedElement& element = body_.stretching.elements[member_];
    const StretchedElement& changed = change.elements[member_];
    const MatrixXd z = dense(body_.stretching.displacements), dz = dense(change.displacements);
    const MatrixXd turned = z.transpose() * element.slopes * dz;
    return {columns_, dz.transpose() * element.elongation, changed.axial_stiffness,
            z.transpose() * changed.slopes * z + turned + turned.transpose()};
  }

 private:
  void note_columns(const SparseMatrix& displacements, std::set<int>& used) const {
    for (const int row : rows_) {
      for (SparseMatrix::InnerIterator entry(displacements, row); entry; ++entry) {
        if (entry.value() != 0.0) used.insert(static_cast<int>(entry.col()));
      }
    }
  }

  MatrixXd dense(const SparseMatrix& displacements) const {
    MatrixXd part(rows_.size(), columns_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        part(i, k) = displacements.coeff(rows_[i], columns_[k]);
      }
    }
    return part;
  }

  const ElasticBody& body_;
  std::size_t member_;
  const std::vector<int>& rows_;
  std::vector<int> columns_;
};

}  // namespace

StretchedMembers stretched_members(const ElasticBody& body) {
  StretchedMembers members;
  for (const auto& [variable, change] : body.stretching_x) {
    members.derivatives.push_back({variable, {}});
  }
  for (std::size_t e = 0; e < body.stretching.elements.size(); ++e) {
    const MemberRows rows(body, e);
    members.values.push_back(rows.value());
    for (std::size_t k = 0; k < body.stretching_x.size(); ++k) {
      members.derivatives[k].data.push_back(rows.derivative(body.stretching_x[k].data));
    }
  }
  return members;
}

}  // namespace pleuel
