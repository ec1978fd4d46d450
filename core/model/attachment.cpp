#include "core/model/attachment.hpp"

#include <cassert>
#include <map>

#include "core/base/eager_matrices.hpp"
#include "core/model/imported_constants.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

Attachment::Attachment(const std::string& body, Point at, const std::vector<BodyModel>& bodies,
                       const BuildContext& context, std::optional<Point> to)
    : context_(context), at_(std::move(at)), to_(std::move(to)) {
  if (body == ground_name) return;
  const auto number = context.body_numbers.find(body);
  assert(number != context.body_numbers.end());
  body_ = &context.scene.bodies[number->second];
  model_ = &bodies[number->second];
  if (const auto* imported = std::get_if<ImportedBody>(&body_->shape)) {
    point_ = point_of(*model_, place_at(*imported, at_, context.start));
  } else if (model_->is_elastic) {
    const auto place = [&](const Point& point) {
      return held_place(*model_,
                        share_along(std::get<BeamBody>(body_->shape), point, context.start));
    };
    point_ = to_ ? mean_point(*model_, place(at_), place(*to_)) : point_of(*model_, place(at_));
  }
  if (point_) set_rows();
  is_direct_ = are_coordinates();
}

/// A place moves with few of the coordinates, if they are nodal ones.
void Attachment::set_rows() {
  std::set<int> used;
  const auto add_used = [&used](const SparseMatrix& shape) {
    for (int row = 0; row < 6; ++row) {
      for (SparseMatrix::InnerIterator entry(shape, row); entry; ++entry) {
        if (entry.value() != 0.0) used.insert(static_cast<int>(entry.col()));
      }
    }
  };
  add_used(point_->shape);
  for (const auto& [variable, change] : point_->derivatives) add_used(change.shape);
  const std::vector<int> columns(used.begin(), used.end());
  for (int column : columns) rows_.coordinates.push_back(model_->elastic_offset() + column);
  const auto part = [&columns](const SparseMatrix& shape) {
    return Eigen::MatrixXd(Eigen::MatrixXd(shape)(Eigen::all, columns));
  };
  rows_.values = part(point_->shape);
  for (const auto& [variable, change] : point_->derivatives) {
    Eigen::MatrixXd rows = part(change.shape);
    if (!rows.isZero(0.0)) rows_.derivatives.push_back({variable, std::move(rows)});
  }
}

bool Attachment::are_coordinates() const {
  if (!rows_.derivatives.empty()) return false;
  const auto ones = rows_.values.array() == 1.0;
  const auto entries = rows_.values.array() != 0.0;
  return ones.count() == entries.count() && (entries.colwise().count() == 1).all() &&
         (entries.rowwise().count() <= 1).all();
}

Marker Attachment::marker() const {
  Marker marker;
  marker.frame = model_ ? model_->frame : ground_frame();
  if (!is_direct()) return marker;
  for (int i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < rows_.coordinates.size(); ++k) {
      if (rows_.values(i, k) == 0.0) continue;
      marker.elastic[i] = rows_.coordinates[k];
    }
  }
  return marker;
}

std::optional<Eigen::Matrix3d> Attachment::beam_axes() const {
  const bool lies_as_beam = model_ != nullptr && (model_->is_beam() || model_->is_imported());
  if (!lies_as_beam) return std::nullopt;
  return body_pose(*body_, context_.start).rotation;
}

Eigen::Vector3d reference_direction(std::span<const Attachment> attachments,
                                    const Eigen::Vector3d& axis) {
  for (const Attachment& attachment : attachments) {
    const auto axes = attachment.beam_axes();
    if (!axes) continue;
    const bool is_along = std::abs(axes->col(0).dot(axis)) > 0.9;
    const Eigen::Vector3d direction = axes->col(is_along ? 1 : 0);
    return (direction - direction.dot(axis) * axis).normalized();
  }
  return axis.unitOrthogonal();
}

Eigen::Vector3d angle_reference(const Joint& joint, std::span<const Attachment> sides) {
  if (kind_of(joint.type).has_second_axis()) return to_vector(joint.second_axis).normalized();
  return reference_direction(sides, to_vector(joint.axis).normalized());
}

void Attachment::add_variables(std::set<int>& variables) const {
  if (body_) variables.merge(variables_of(*body_, context_.scene));
  if (point_) {
    for (const auto& [variable, change] : point_->derivatives) variables.insert(variable);
  }
  add_variables_of(at_, variables);
  if (to_) add_variables_of(*to_, variables);
}

namespace {

/// Grows the map by the coordinates of one attachment.
class LocalNumbering {
 public:
  void add(const Attachment& attachment, Marker& marker) {
    const int frame = marker.frame.size(), first = size_;
    for (int i = 0; i < frame; ++i) set(size_++, column(marker.frame.offset + i), 1.0);
    marker.frame.offset = first;
    const Attachment::Rows& rows = attachment.displacement_rows();
    for (int i = 0; i < 6; ++i) {
      int& local = marker.elastic[i];
      local = -1;
      if (is_zero(rows, i)) continue;
      local = size_++;
      for (std::size_t k = 0; k < rows.coordinates.size(); ++k) {
        set(local, column(rows.coordinates[k]), rows.values(i, k));
        for (const auto& [variable, change] : rows.derivatives) {
          changes_[variable].push_back({local, column(rows.coordinates[k]), change(i, k)});
        }
      }
    }
  }

  CoordinateMap finish() {
    CoordinateMap map;
    map.coordinates = coordinates_;
    map.rows = matrix(entries_);
    for (const auto& [variable, entries] : changes_) {
      map.derivatives.push_back({variable, matrix(entries)});
    }
    return map;
  }

 private:
  struct Entry {
    int row, column;
    double value;
  };

  static bool is_zero(const Attachment::Rows& rows, int row) {
    bool zero = rows.values.row(row).isZero(0.0);
    for (const auto& [variable, change] : rows.derivatives) {
      zero = zero && change.row(row).isZero(0.0);
    }
    return zero;
  }

  int column(int coordinate) {
    const auto [entry, is_new] = columns_.try_emplace(coordinate, coordinates_.size());
    if (is_new) coordinates_.push_back(coordinate);
    return static_cast<int>(entry->second);
  }
  void set(int row, int column, double value) { entries_.push_back({row, column, value}); }

  Eigen::MatrixXd matrix(const std::vector<Entry>& entries) const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size_, coordinates_.size());
    for (const Entry& entry : entries) result(entry.row, entry.column) += entry.value;
    return result;
  }

  int size_ = 0;
  std::vector<int> coordinates_;
  std::map<int, std::size_t> columns_;
  std::vector<Entry> entries_;
  std::map<int, std::vector<Entry>> changes_;
};

}  // namespace

CoordinateMap make_local(std::span<const Attachment> attachments, std::span<Marker> markers) {
  LocalNumbering numbering;
  for (std::size_t i = 0; i < attachments.size(); ++i) numbering.add(attachments[i], markers[i]);
  return numbering.finish();
}

}  // namespace pleuel
