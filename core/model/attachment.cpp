#include "core/model/attachment.hpp"

#include <algorithm>
#include <cassert>
#include <map>

#include "core/model/beam_mesh.hpp"
#include "core/model/imported_builder.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

Attachment::Attachment(const std::string& body, Point at, const std::vector<BodyModel>& bodies,
                       const BuildContext& context)
    : context_(context), at_(std::move(at)) {
  if (body == ground_name) return;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (context.scene.bodies[i].name != body) continue;
    body_ = &context.scene.bodies[i];
    model_ = &bodies[i];
  }
  assert(body_ != nullptr);
  if (const auto* imported = std::get_if<ImportedBody>(&body_->shape)) {
    imported_place_ = place_at(*imported, at_, context.start);
  } else if (is_elastic()) {
    place_ = find_place(model_->beam, share_along(beam_body(), at_, context.start));
  }
}

bool Attachment::is_direct() const {
  return !is_elastic() || (model_->is_beam() && place_.is_node() && !model_->basis);
}

Marker Attachment::marker() const {
  Marker marker;
  marker.frame = model_ ? model_->frame : ground_frame();
  if (!is_elastic() || !is_direct()) return marker;
  for (int i = 0; i < 6; ++i) {
    marker.elastic[static_cast<std::size_t>(i)] = model_->coordinate(place_.node(), i);
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

void Attachment::add_variables(std::set<int>& variables) const {
  if (body_) variables.merge(variables_of(*body_, context_.scene));
  for (const Number& number : at_) {
    if (number.is_bound()) variables.insert(number.variable);
  }
}

/// In the nodal coordinates of a body (or of its nodal view), numbered as that body does.
Attachment::Rows Attachment::nodal_rows(const BodyModel& body) const {
  Rows rows;
  std::vector<int> local;
  for (int i = 0; i < 12; ++i) {
    const int index = body.coordinate(place_.element + i / 6, i % 6);
    if (index < 0) continue;
    local.push_back(i);
    rows.coordinates.push_back(index);
  }
  const auto element = static_cast<std::size_t>(place_.element);
  const auto all = Eigen::all;
  rows.values = place_shape(place_, body.beam.elements[element].length)(all, local);
  for (const auto& [variable, beam] : body.beam_x) {
    const Eigen::MatrixXd change =
        derivative_matrix(place_shape(place_, beam.elements[element].length));
    if (!change.isZero(0.0)) rows.derivatives.push_back({variable, change(all, local)});
  }
  return rows;
}

Attachment::Rows Attachment::imported_rows() const {
  const auto stack = [](const BodyPlace& place) {
    Eigen::MatrixXd rows(6, place.displacement.cols());
    rows << Eigen::MatrixXd(place.displacement), Eigen::MatrixXd(place.rotation);
    return rows;
  };
  const Eigen::MatrixXd values = stack(imported_place(*model_->constants));
  std::vector<DesignDerivative<Eigen::MatrixXd>> changes;
  for (const auto& [variable, change] : model_->constants_x) {
    changes.push_back({variable, stack(imported_place(change))});
  }
  // A place moves with few of the coordinates, if they are nodal ones.
  std::vector<int> used;
  for (int i = 0; i < model_->elastic_size(); ++i) {
    const bool moves = !values.col(i).isZero(0.0) ||
                       std::any_of(changes.begin(), changes.end(), [i](const auto& change) {
                         return !change.data.col(i).isZero(0.0);
                       });
    if (moves) used.push_back(i);
  }
  Rows rows;
  for (int i : used) rows.coordinates.push_back(model_->elastic_offset() + i);
  rows.values = values(Eigen::all, used);
  for (const auto& [variable, change] : changes) {
    if (!change.isZero(0.0)) rows.derivatives.push_back({variable, change(Eigen::all, used)});
  }
  return rows;
}

Attachment::Rows Attachment::displacement_rows() const {
  if (!is_elastic()) return {{}, Eigen::MatrixXd::Zero(6, 0), {}};
  if (model_->is_imported()) return imported_rows();
  if (!model_->basis) return nodal_rows(*model_);
  const Rows nodal = nodal_rows(*model_->nodal);
  const CoordinateMap& map = model_->map;
  Rows rows;
  // Without the columns of the frame.
  const int frame = model_->frame.size(), columns = map.columns() - frame;
  rows.coordinates.assign(map.coordinates.begin() + frame, map.coordinates.end());
  const auto part = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
    return matrix(nodal.coordinates, Eigen::lastN(columns));
  };
  rows.values = nodal.values * part(map.rows);
  std::map<int, Eigen::MatrixXd> derivatives;
  const auto add = [&](int variable, const Eigen::MatrixXd& change) {
    auto [entry, is_new] = derivatives.try_emplace(variable, change);
    if (!is_new) entry->second += change;
  };
  for (const auto& [variable, change] : nodal.derivatives) add(variable, change * part(map.rows));
  for (const auto& [variable, change] : map.derivatives) add(variable, nodal.values * part(change));
  for (auto& [variable, change] : derivatives) {
    rows.derivatives.push_back({variable, std::move(change)});
  }
  return rows;
}

namespace {

/// Grows the map by the coordinates of one attachment.
class LocalNumbering {
 public:
  void add(const Attachment& attachment, Marker& marker) {
    const int frame = marker.frame.size(), first = size_;
    for (int i = 0; i < frame; ++i) set(size_++, column(marker.frame.offset + i), 1.0);
    marker.frame.offset = first;
    const Attachment::Rows rows = attachment.displacement_rows();
    for (int i = 0; i < 6; ++i) {
      int& local = marker.elastic[static_cast<std::size_t>(i)];
      local = -1;
      if (is_zero(rows, i)) continue;
      local = size_++;
      for (std::size_t k = 0; k < rows.coordinates.size(); ++k) {
        const auto column_of_row = static_cast<Eigen::Index>(k);
        set(local, column(rows.coordinates[k]), rows.values(i, column_of_row));
        for (const auto& [variable, change] : rows.derivatives) {
          changes_[variable].push_back(
              {local, column(rows.coordinates[k]), change(i, column_of_row)});
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
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Zero(size_, static_cast<Eigen::Index>(coordinates_.size()));
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
